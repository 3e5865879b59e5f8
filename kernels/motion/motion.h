/* Motion of one element (design.md section 2): from the total force and moment on it to the rates of its fields. */

typedef struct {
  REAL inverse_mass;
  vec frame;
  spin inertia, inverse_inertia;
} mass_law; /* [1/kg], [m/s^2], [kg m^2], [1/(kg m^2)] */
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

static inline vec acceleration(vec force, mass_law mass) { return vec_axpy(mass.inverse_mass, force, mass.frame); }

/* A cube's inertia is a scalar and has no gyroscopic term. */
static inline spin angular_acceleration(spin moment, element e, mass_law mass, const int is_gyroscopic) {
  if (is_gyroscopic) return spin_euler(moment, e.w, e.q, mass.inertia, mass.inverse_inertia);
  return spin_scaled(moment, mass.inverse_inertia);
}
