/* Rotors of small rotations in space: r is half the rotation vector. To first order r is the vector
 * part of the quaternion. Rotations add up, and A = I + 2 [r]x. */
#include "kernels/algebra/space.h"

typedef struct {
  REAL x, y, z;
} rotor;

/* (A - I) (edge / 2) e_axis = edge r x e_axis */
static inline vec rotor_turn(rotor q, const int axis, REAL edge) {
  if (axis == 0) {
    vec r = {SPLAT(0), edge * q.z, -(edge * q.y)};
    return r;
  } else if (axis == 1) {
    vec r = {-(edge * q.z), SPLAT(0), edge * q.x};
    return r;
  } else {
    vec r = {edge * q.y, -(edge * q.x), SPLAT(0)};
    return r;
  }
}

/* Rotation from i to j. The scalar part s is of second order, so it is zero here. */
static inline spin rotor_relative(rotor i, rotor j) {
  spin r = {j.x - i.x, j.y - i.y, j.z - i.z};
  return r;
}
static inline REAL rotor_relative_s(rotor i, rotor j) {
  (void)i;
  (void)j;
  return SPLAT(0);
}
static inline spin rotor_vector(rotor q) {
  spin r = {q.x, q.y, q.z};
  return r;
}
static inline REAL rotor_sign_of_life(rotor q) { return q.x; }

/* 2 r' = w */
static inline rotor rotor_spun(rotor q, spin w) {
  (void)q;
  rotor r = {w.x, w.y, w.z};
  return r;
}
/* Change of r by the rotation vector 4 b. */
static inline rotor rotor_cayley_change(rotor q, spin b) {
  (void)q;
  rotor r = {SPLAT(2) * b.x, SPLAT(2) * b.y, SPLAT(2) * b.z};
  return r;
}
static inline rotor rotor_cayley(rotor q, spin b) {
  rotor r = {FMA(SPLAT(2), b.x, q.x), FMA(SPLAT(2), b.y, q.y), FMA(SPLAT(2), b.z, q.z)};
  return r;
}
