/* Motion of one element (DESIGN.md section 2): from the total force and moment on it to what the update needs.
 *   u' = v,   v' = force / m,   q' = w q / 2,   w' = turn / I
 * The factors 1/m, 1/2 and 1/I meet the step's factor in the update's constants (kernels/rk_update), never in the loop. */

/* What w' is proportional to: the moment itself where the inertia is a scalar I (a cube), else w' by Euler's equation,
 * with I = 1. */
static inline spin turn(spin moment, element e, spin inertia, spin inverse_inertia, const int is_gyroscopic) {
  if (is_gyroscopic) return spin_euler(moment, e.w, e.q, inertia, inverse_inertia);
  return moment;
}

typedef struct {
  REAL k, d, k2_rot, d_rot;
} tie_law; /* stabilization: [N/m], [N s/m], twice k_rot [N m/rad], [N m s/rad] */

/* Stabilization s(y', y): springs and dampers between the element and the frame, added to its force and moment. */
static inline vec tie_force(element e, tie_law tie, vec force) {
  return vec_axpy(-tie.k, e.u, vec_axpy(-tie.d, e.v, force));
}
static inline spin tie_moment(element e, tie_law tie, spin moment) {
  return spin_axpy(-tie.k2_rot, rotor_vector(e.q), spin_axpy(-tie.d_rot, e.w, moment));
}
