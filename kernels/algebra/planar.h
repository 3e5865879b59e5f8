/* Algebra of the planar model (shared subset): spatial.h restricted to motion in a plane z = const.
 * It is exact for such motion. A vector has the components x and y, a spin has z, and a rotor is
 * the quaternion (1 + s, 0, 0, z). space.h and spatial.h explain the operations. */
#define AXES 2
#define PLANAR

#include "kernels/algebra/plane.h"

typedef struct {
  REAL s, z;
} rotor;

static inline vec rotor_turn(rotor q, const int axis, REAL edge) {
  REAL q0 = q.s + SPLAT(1), z = edge * q.z;
  if (axis == 0) {
    vec r = {-(z * q.z), z * q0};
    return r;
  } else {
    vec r = {-(z * q0), -(z * q.z)};
    return r;
  }
}
static inline vec rotor_column(rotor q, const int axis) {
  return vec_along(rotor_turn(q, axis, SPLAT(2)), axis, SPLAT(1));
}

#include "kernels/algebra/turning_lever.h"

static inline spin rotor_relative(rotor i, rotor j) {
  REAL i0 = i.s + SPLAT(1), j0 = j.s + SPLAT(1);
  spin r = {FMA(j.z, i0, -(j0 * i.z))};
  return r;
}
static inline REAL rotor_relative_s(rotor i, rotor j) {
  return FMA(i.s, j.s, i.s + j.s) + i.z * j.z;
}
static inline spin rotor_vector(rotor q) {
  spin r = {q.z};
  return r;
}

static inline REAL rotor_sign_of_life(rotor q) { return q.s; }

static inline rotor rotor_spun(rotor q, spin w) {
  REAL q0 = q.s + SPLAT(1);
  rotor r = {-(w.z * q.z), w.z * q0};
  return r;
}
static inline rotor rotor_cayley_change(rotor q, spin b) {
  REAL q0 = q.s + SPLAT(1), n2 = spin_norm2(b), c = SPLAT(2) / (SPLAT(1) + n2), ds = -(c * n2),
       d = c * b.z;
  rotor r = {FMA(ds, q0, -(d * q.z)), FMA(ds, q.z, d * q0)};
  return r;
}
static inline rotor rotor_cayley(rotor q, spin b) {
  rotor d = rotor_cayley_change(q, b);
  rotor r = {q.s + d.s, q.z + d.z};
  return r;
}

/* The axis of rotation is a principal axis, so there is no gyroscopic term. */
static inline spin spin_euler(spin t, spin w, rotor q, spin inertia, spin inverse_inertia) {
  (void)w;
  (void)q;
  (void)inertia;
  spin r = {inverse_inertia.z * t.z};
  return r;
}
