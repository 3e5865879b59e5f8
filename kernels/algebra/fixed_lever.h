/* Levers of elements whose arms stay as they are at rest: along their axis, so that a length is all. */
typedef REAL lever;
static inline lever lever_of(vec turn, const int axis, REAL half_edge) {
  (void)turn;
  (void)axis;
  return half_edge;
}
