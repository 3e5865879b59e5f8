/* Algebra of the membrane model (shared subset): linear.h restricted to the displacements ux, uy
 * and the rotation about z. A vector has the components x and y; spins and rotors have z. space.h
 * and spatial.h explain the operations. */
#define AXES 2
#define PLANAR
#define LINEAR

#include "kernels/algebra/plane.h"

typedef struct {
  REAL z;
} rotor;

static inline vec rotor_turn(rotor q, const int axis, REAL edge) {
  REAL across = edge * q.z;
  vec r = {axis == 0 ? SPLAT(0) : -across, axis == 0 ? across : SPLAT(0)};
  return r;
}

#include "kernels/algebra/fixed_lever.h"

static inline vec lever_rate(spin w, lever a, const int axis, vec t) {
  if (axis == 0)
    t.y = FMA(w.z, a, t.y);
  else
    t.x = FMA(-w.z, a, t.x);
  return t;
}
static inline spin lever_moment(lever a, const int axis, vec f, spin t) {
  t.z = axis == 0 ? FMA(a, f.y, t.z) : FMA(-a, f.x, t.z);
  return t;
}
static inline spin lever_cross(lever a, const int axis, vec f) {
  spin r = {axis == 0 ? a * f.y : -(a * f.x)};
  return r;
}

static inline vec vec_principal(vec a, const int axis, REAL across, REAL along) {
  vec r = vec_scale(across, a);
  if (axis == 0)
    r.x = FMA(along, a.x, r.x);
  else
    r.y = FMA(along, a.y, r.y);
  return r;
}
/* The plane has no third axis. */
static inline vec vec_axpy_along(REAL k, vec a, const int axis, vec r) {
  (void)k, (void)a, (void)axis;
  return r;
}
static inline spin spin_principal(spin a, REAL z, REAL xz, REAL yz) {
  (void)xz;
  (void)yz;
  return spin_scale(z, a);
}

static inline spin rotor_relative(rotor i, rotor j) {
  spin r = {j.z - i.z};
  return r;
}
static inline spin rotor_vector(rotor q) {
  spin r = {q.z};
  return r;
}
static inline REAL rotor_sign_of_life(rotor q) { return q.z; }
static inline rotor rotor_spun(rotor q, spin w) {
  (void)q;
  rotor r = {w.z};
  return r;
}
static inline rotor rotor_cayley_change(rotor q, spin b) {
  (void)q;
  rotor r = {SPLAT(2) * b.z};
  return r;
}
static inline rotor rotor_cayley(rotor q, spin b) {
  rotor r = {FMA(SPLAT(2), b.z, q.z)};
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
