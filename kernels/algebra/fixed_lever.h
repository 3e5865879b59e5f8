/* Levers of the linear models. The arm keeps its direction at rest, along the axis, so its length
 * [m] is enough. */
typedef REAL lever;
static inline lever lever_of(vec turn, const int axis, REAL half_edge) {
  (void)turn;
  (void)axis;
  return half_edge;
}
