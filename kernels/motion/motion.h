/* Motion of one element (DESIGN.md section 2), from its total force and moment:
 *   u' = v,   v' = force / m,   q' = w q / 2,   w' = turn / I
 * The constants of the update (kernels/rk_update) hold the factors 1/m, 1/2 and 1/I times the step,
 * so the loop does not multiply by them. */

/* `turn` is proportional to w'. It is the moment if the inertia is a scalar I (a cube). Otherwise
 * it is w' from Euler's equation, and I = 1. */
static inline spin turn(spin moment, element e, spin inertia, spin inverse_inertia,
                        const int is_gyroscopic) {
  if (is_gyroscopic) return spin_euler(moment, e.w, e.q, inertia, inverse_inertia);
  return moment;
}

typedef struct {
  REAL k, d, k2_rot, d_rot;
  /* Stabilization constants: k [N/m], d [N s/m], k2_rot twice k_rot [N m/rad], d_rot [N m s/rad] */
} tie_law;

/* Stabilization s(y', y): springs and dampers between element and frame. Each function adds its
 * part to the element's force or moment. */
static inline vec tie_force(element e, tie_law tie, vec force) {
  return vec_axpy(-tie.k, e.u, vec_axpy(-tie.d, e.v, force));
}
static inline spin tie_moment(element e, tie_law tie, spin moment) {
  return spin_axpy(-tie.k2_rot, rotor_vector(e.q), spin_axpy(-tie.d_rot, e.w, moment));
}

#ifdef HAS_FRAME
/* A frame that rotates, with the angular velocity W (rate) and its derivative W' (change). Against
 * fixed axes, a place x in it has the velocity v + W x x, and an element the spin w + W. */
typedef struct {
  spin rate, change;
} frame_turn;

/* Adds the inertia of a mass at x = rest + u to a force:
 *   -m (W' x x + W x (W x x + 2 v)) */
static inline vec frame_force(element e, vec rest, frame_turn frame, REAL mass, vec force) {
  vec x = vec_add(rest, e.u);
  vec speed = spin_cross_add(frame.rate, x, vec_scale(SPLAT(2), e.v));
  return vec_axpy(-mass, spin_cross_add(frame.change, x, spin_cross(frame.rate, speed)), force);
}
/* As turn() with the inertia as a tensor:
 *   J^-1 (t - (w + W) x J (w + W)) - W' - W x w */
static inline spin turn_in_frame(spin moment, element e, frame_turn frame, spin inertia,
                                 spin inverse_inertia) {
  spin whole = spin_euler(moment, spin_add(e.w, frame.rate), e.q, inertia, inverse_inertia);
  vec spun = {e.w.x, e.w.y, e.w.z}, direction = spin_cross(frame.rate, spun);
  spin relative = {direction.x, direction.y, direction.z};
  return spin_sub(whole, spin_add(frame.change, relative));
}
#endif
