/* Algebra of the small model (shared subset): spatial.h with rotation vectors in place of
 * quaternions, A = I + [theta]x, exact to first order in theta. Arms turn with the element.
 * Products of a rotation with forces or velocities are kept. The inertia stays in the axes of the
 * frame. */
#define AXES 3
#include "kernels/algebra/rotation_vector.h"
#include "kernels/algebra/turning_lever.h"

static inline vec rotor_column(rotor q, const int axis) {
  return vec_along(rotor_turn(q, axis, SPLAT(2)), axis, SPLAT(1));
}

/* J^-1 (t - w x J w) with J = diag(inertia). */
static inline spin spin_euler(spin t, spin w, rotor q, spin inertia, spin inverse_inertia) {
  (void)q;
  spin a = {inverse_inertia.x * FMA(w.y * w.z, inertia.y - inertia.z, t.x),
            inverse_inertia.y * FMA(w.z * w.x, inertia.z - inertia.x, t.y),
            inverse_inertia.z * FMA(w.x * w.y, inertia.x - inertia.y, t.z)};
  return a;
}
