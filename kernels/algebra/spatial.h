/* Algebra of the spatial model (shared subset). Vectors and spins have three components; a rotor is
 * a unit quaternion. A model is an algebra: the laws of motion use only these operations, and every
 * other algebra defines the same list (kernels/README.md). The includer defines the words REAL,
 * FMA(a, b, c) = a * b + c and SPLAT(scalar). */
#define AXES 3
#define HAS_FRAME /* it computes in a frame that rotates */
#include "kernels/algebra/space.h"

typedef struct {
  REAL s, x, y, z;
} rotor; /* unit quaternion (1 + s, x, y, z); all zeros at rest */

/* (A - I) (edge / 2) e_axis: displacement of a face's centre by the rotation. It is a column of
 * A - I = 2 (q0 [r]x + [r]x^2). */
static inline vec rotor_turn(rotor q, const int axis, REAL edge) {
  REAL q0 = q.s + SPLAT(1);
  if (axis == 0) {
    REAL y = edge * q.y, z = edge * q.z;
    vec r = {FMA(-y, q.y, -(z * q.z)), FMA(y, q.x, z * q0), FMA(z, q.x, -(y * q0))};
    return r;
  } else if (axis == 1) {
    REAL x = edge * q.x, z = edge * q.z;
    vec r = {FMA(x, q.y, -(z * q0)), FMA(-x, q.x, -(z * q.z)), FMA(z, q.y, x * q0)};
    return r;
  } else {
    REAL x = edge * q.x, y = edge * q.y;
    vec r = {FMA(x, q.z, y * q0), FMA(y, q.z, -(x * q0)), FMA(-x, q.x, -(y * q.y))};
    return r;
  }
}
/* A e_axis: direction of a body axis in the global frame */
static inline vec rotor_column(rotor q, const int axis) {
  return vec_along(rotor_turn(q, axis, SPLAT(2)), axis, SPLAT(1));
}

#include "kernels/algebra/turning_lever.h"

/* Vector part of p = q_j conj(q_i), the rotation from i to j in global axes; then its
 * s = p0 - 1. */
static inline spin rotor_relative(rotor i, rotor j) {
  REAL i0 = i.s + SPLAT(1), j0 = j.s + SPLAT(1);
  spin r = {FMA(j.x, i0, FMA(-j0, i.x, FMA(j.z, i.y, -(j.y * i.z)))),
            FMA(j.y, i0, FMA(-j0, i.y, FMA(j.x, i.z, -(j.z * i.x)))),
            FMA(j.z, i0, FMA(-j0, i.z, FMA(j.y, i.x, -(j.x * i.y))))};
  return r;
}
static inline REAL rotor_relative_s(rotor i, rotor j) {
  return FMA(i.s, j.s, i.s + j.s) + FMA(i.x, j.x, FMA(i.y, j.y, i.z * j.z));
}
/* Vector part of a rotor: half the rotation vector if the rotation is small. */
static inline spin rotor_vector(rotor q) {
  spin r = {q.x, q.y, q.z};
  return r;
}

/* One component that is not finite if the rotor is not. */
static inline REAL rotor_sign_of_life(rotor q) { return q.s; }

/* w q = 2 q', with w in global axes */
static inline rotor rotor_spun(rotor q, spin w) {
  REAL q0 = q.s + SPLAT(1);
  rotor r = {FMA(-w.x, q.x, FMA(-w.y, q.y, -(w.z * q.z))),
             FMA(w.x, q0, FMA(w.y, q.z, -(w.z * q.y))), FMA(w.y, q0, FMA(w.z, q.x, -(w.x * q.z))),
             FMA(w.z, q0, FMA(w.x, q.y, -(w.y * q.x)))};
  return r;
}
/* Cayley map: dq q with dq = (1 - |b|^2, 2 b) / (1 + |b|^2), a rotation by 4 atan |b| about b that
 * keeps |q| = 1. rotor_cayley_change gives dq q - q, rotor_cayley gives dq q. */
static inline rotor rotor_cayley_change(rotor q, spin b) {
  REAL q0 = q.s + SPLAT(1), n2 = spin_norm2(b), c = SPLAT(2) / (SPLAT(1) + n2), ds = -(c * n2);
  spin d = spin_scale(c, b);
  rotor r = {FMA(ds, q0, -FMA(d.x, q.x, FMA(d.y, q.y, d.z * q.z))),
             FMA(ds, q.x, FMA(d.x, q0, FMA(d.y, q.z, -(d.z * q.y)))),
             FMA(ds, q.y, FMA(d.y, q0, FMA(d.z, q.x, -(d.x * q.z)))),
             FMA(ds, q.z, FMA(d.z, q0, FMA(d.x, q.y, -(d.y * q.x))))};
  return r;
}
static inline rotor rotor_cayley(rotor q, spin b) {
  rotor d = rotor_cayley_change(q, b);
  rotor r = {q.s + d.s, q.x + d.x, q.y + d.y, q.z + d.z};
  return r;
}

/* Euler's equation: angular acceleration J^-1 (t - w x J w) of a box, J = A diag(inertia) A^T.
 * `inertia` holds the principal moments about the box's own axes. */
static inline spin spin_euler(spin t, spin w, rotor q, spin inertia, spin inverse_inertia) {
  vec cx = rotor_column(q, 0), cy = rotor_column(q, 1), cz = rotor_column(q, 2);
  spin wb = {spin_dot(w, cx), spin_dot(w, cy), spin_dot(w, cz)},
       tb = {spin_dot(t, cx), spin_dot(t, cy), spin_dot(t, cz)};
  spin a = {inverse_inertia.x * FMA(wb.y * wb.z, inertia.y - inertia.z, tb.x),
            inverse_inertia.y * FMA(wb.z * wb.x, inertia.z - inertia.x, tb.y),
            inverse_inertia.z * FMA(wb.x * wb.y, inertia.x - inertia.y, tb.z)};
  return spin_about(a.z, cz, spin_about(a.y, cy, spin_about(a.x, cx, spin_zero())));
}
