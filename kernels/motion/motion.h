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
