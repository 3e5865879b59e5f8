/* Algebra of the bending model (shared subset): linear.h restricted to the deflection uz and the
 * rotations about x and y. A vector has the component z; spins and rotors have x and y. space.h and
 * spatial.h explain the operations. */
#define AXES 2
#define LINEAR

typedef struct {
  REAL z;
} vec;
typedef struct {
  REAL x, y;
} spin;
typedef struct {
  REAL x, y;
} rotor;

static inline vec vec_add(vec a, vec b) {
  vec r = {a.z + b.z};
  return r;
}
static inline vec vec_sub(vec a, vec b) {
  vec r = {a.z - b.z};
  return r;
}
static inline vec vec_scale(REAL k, vec a) {
  vec r = {k * a.z};
  return r;
}
static inline vec vec_axpy(REAL k, vec a, vec b) {
  vec r = {FMA(k, a.z, b.z)};
  return r;
}

static inline vec vec_along(vec a, const int axis, REAL c) {
  if (axis == 2) a.z = a.z + c;
  return a;
}
static inline REAL vec_component(vec a, const int axis) { return axis == 2 ? a.z : SPLAT(0); }

static inline spin spin_zero(void) {
  spin r = {SPLAT(0), SPLAT(0)};
  return r;
}
static inline REAL spin_component(spin a, const int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : SPLAT(0);
}
static inline spin spin_along(spin a, const int axis, REAL c) {
  if (axis == 0) a.x = a.x + c;
  if (axis == 1) a.y = a.y + c;
  return a;
}
static inline spin spin_add(spin a, spin b) {
  spin r = {a.x + b.x, a.y + b.y};
  return r;
}
static inline spin spin_sub(spin a, spin b) {
  spin r = {a.x - b.x, a.y - b.y};
  return r;
}
static inline spin spin_scale(REAL k, spin a) {
  spin r = {k * a.x, k * a.y};
  return r;
}
static inline spin spin_axpy(REAL k, spin a, spin b) {
  spin r = {FMA(k, a.x, b.x), FMA(k, a.y, b.y)};
  return r;
}

static inline vec rotor_turn(rotor q, const int axis, REAL edge) {
  vec r = {axis == 0 ? -(edge * q.y) : edge * q.x};
  return r;
}

#include "kernels/algebra/fixed_lever.h"

static inline vec lever_rate(spin w, lever a, const int axis, vec t) {
  vec r = {axis == 0 ? FMA(-w.y, a, t.z) : FMA(w.x, a, t.z)};
  return r;
}
static inline spin lever_moment(lever a, const int axis, vec f, spin t) {
  if (axis == 0)
    t.y = FMA(-a, f.z, t.y);
  else
    t.x = FMA(a, f.z, t.x);
  return t;
}
static inline spin lever_cross(lever a, const int axis, vec f) {
  spin r = {axis == 0 ? SPLAT(0) : a * f.z, axis == 0 ? -(a * f.z) : SPLAT(0)};
  return r;
}

/* All links lie in the plane, so the deflection is always across the link. */
static inline vec vec_principal(vec a, const int axis, REAL across, REAL along) {
  (void)axis;
  (void)along;
  return vec_scale(across, a);
}
/* r + k (e_z.a) e_z; `axis` is z */
static inline vec vec_axpy_along(REAL k, vec a, const int axis, vec r) {
  (void)axis;
  return vec_axpy(k, a, r);
}
static inline spin spin_principal(spin a, REAL z, REAL xz, REAL yz) {
  spin r = {FMA(xz, a.x, z * a.x), FMA(yz, a.y, z * a.y)};
  return r;
}

static inline spin rotor_relative(rotor i, rotor j) {
  spin r = {j.x - i.x, j.y - i.y};
  return r;
}
static inline spin rotor_vector(rotor q) {
  spin r = {q.x, q.y};
  return r;
}
static inline REAL rotor_sign_of_life(rotor q) { return q.x; }
static inline rotor rotor_spun(rotor q, spin w) {
  (void)q;
  rotor r = {w.x, w.y};
  return r;
}
static inline rotor rotor_cayley_change(rotor q, spin b) {
  (void)q;
  rotor r = {SPLAT(2) * b.x, SPLAT(2) * b.y};
  return r;
}
static inline rotor rotor_cayley(rotor q, spin b) {
  rotor r = {FMA(SPLAT(2), b.x, q.x), FMA(SPLAT(2), b.y, q.y)};
  return r;
}
static inline spin spin_euler(spin t, spin w, rotor q, spin inertia, spin inverse_inertia) {
  (void)w;
  (void)q;
  (void)inertia;
  spin a = {inverse_inertia.x * t.x, inverse_inertia.y * t.y};
  return a;
}
