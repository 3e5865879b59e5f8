/* Algebra of the linear model (shared subset): small.h with arms that keep their direction at rest,
 * so forces are linear in the state. LINEAR makes the material law
 * linear too (kernels/link_force/link_force.h). */
#define AXES 3
#define LINEAR
#include "kernels/algebra/rotation_vector.h"

#include "kernels/algebra/fixed_lever.h"

static inline vec lever_rate(spin w, lever a, const int axis, vec t) {
  if (axis == 0) {
    vec r = {t.x, FMA(w.z, a, t.y), FMA(-w.y, a, t.z)};
    return r;
  } else if (axis == 1) {
    vec r = {FMA(-w.z, a, t.x), t.y, FMA(w.x, a, t.z)};
    return r;
  } else {
    vec r = {FMA(w.y, a, t.x), FMA(-w.x, a, t.y), t.z};
    return r;
  }
}
static inline spin lever_cross(lever a, const int axis, vec f) {
  if (axis == 0) {
    spin r = {SPLAT(0), -(a * f.z), a * f.y};
    return r;
  } else if (axis == 1) {
    spin r = {a * f.z, SPLAT(0), -(a * f.x)};
    return r;
  } else {
    spin r = {-(a * f.y), a * f.x, SPLAT(0)};
    return r;
  }
}
static inline spin lever_moment(lever a, const int axis, vec f, spin t) {
  if (axis == 0) {
    spin r = {t.x, FMA(-a, f.z, t.y), FMA(a, f.y, t.z)};
    return r;
  } else if (axis == 1) {
    spin r = {FMA(a, f.z, t.x), t.y, FMA(-a, f.x, t.z)};
    return r;
  } else {
    spin r = {FMA(-a, f.y, t.x), FMA(a, f.x, t.y), t.z};
    return r;
  }
}

/* r + k (e.a) e, e the direction of the axis */
static inline vec vec_axpy_along(REAL k, vec a, const int axis, vec r) {
  if (axis == 0) r.x = FMA(k, a.x, r.x);
  if (axis == 1) r.y = FMA(k, a.y, r.y);
  if (axis == 2) r.z = FMA(k, a.z, r.z);
  return r;
}
/* across a + along (e_axis.a) e_axis */
static inline vec vec_principal(vec a, const int axis, REAL across, REAL along) {
  return vec_axpy_along(along, a, axis, vec_scale(across, a));
}
/* z a + xz (e_x.a) e_x + yz (e_y.a) e_y */
static inline spin spin_principal(spin a, REAL z, REAL xz, REAL yz) {
  spin r = {FMA(xz, a.x, z * a.x), FMA(yz, a.y, z * a.y), z * a.z};
  return r;
}

/* J^-1 t with J = diag(inertia). The gyroscopic term is of second order and left out. */
static inline spin spin_euler(spin t, spin w, rotor q, spin inertia, spin inverse_inertia) {
  (void)w;
  (void)q;
  (void)inertia;
  spin a = {inverse_inertia.x * t.x, inverse_inertia.y * t.y, inverse_inertia.z * t.z};
  return a;
}
