/* Levers of elements that turn: the arm a = A c from the centre of an element to the centre of a
 * face. `turn` is (A - I) c. */
typedef vec lever;
static inline lever lever_of(vec turn, const int axis, REAL half_edge) {
  return vec_along(turn, axis, half_edge);
}
/* lever_rate: t + w x a; lever_cross: a x f; lever_moment: t + a x f */
static inline vec lever_rate(spin w, lever a, const int axis, vec t) {
  (void)axis;
  return spin_cross_add(w, a, t);
}
static inline spin lever_cross(lever a, const int axis, vec f) {
  (void)axis;
  return vec_cross(a, f);
}
static inline spin lever_moment(lever a, const int axis, vec f, spin t) {
  (void)axis;
  return vec_moment(a, f, t);
}
