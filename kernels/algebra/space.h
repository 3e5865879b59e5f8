/* Vectors and spins with three components (shared subset), for the models in space. The includer
 * defines the words REAL, FMA(a, b, c) = a * b + c and SPLAT(scalar): kernels/README.md. */

typedef struct {
  REAL x, y, z;
} vec; /* displacement, velocity, force */
typedef struct {
  REAL x, y, z;
} spin; /* angular velocity, moment; twice the vector part of a small rotor */

static inline vec vec_add(vec a, vec b) {
  vec r = {a.x + b.x, a.y + b.y, a.z + b.z};
  return r;
}
static inline vec vec_sub(vec a, vec b) {
  vec r = {a.x - b.x, a.y - b.y, a.z - b.z};
  return r;
}
static inline vec vec_scale(REAL k, vec a) {
  vec r = {k * a.x, k * a.y, k * a.z};
  return r;
}
/* k a + b */
static inline vec vec_axpy(REAL k, vec a, vec b) {
  vec r = {FMA(k, a.x, b.x), FMA(k, a.y, b.y), FMA(k, a.z, b.z)};
  return r;
}
static inline REAL vec_dot(vec a, vec b) { return FMA(a.z, b.z, FMA(a.y, b.y, a.x * b.x)); }
/* a + c e_axis; `axis` is a constant at every call */
static inline vec vec_along(vec a, const int axis, REAL c) {
  if (axis == 0) a.x = a.x + c;
  if (axis == 1) a.y = a.y + c;
  if (axis == 2) a.z = a.z + c;
  return a;
}

static inline REAL vec_component(vec a, const int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

static inline spin spin_zero(void) {
  spin r = {SPLAT(0), SPLAT(0), SPLAT(0)};
  return r;
}
static inline spin spin_add(spin a, spin b) {
  spin r = {a.x + b.x, a.y + b.y, a.z + b.z};
  return r;
}
static inline spin spin_sub(spin a, spin b) {
  spin r = {a.x - b.x, a.y - b.y, a.z - b.z};
  return r;
}
static inline spin spin_scale(REAL k, spin a) {
  spin r = {k * a.x, k * a.y, k * a.z};
  return r;
}
static inline spin spin_axpy(REAL k, spin a, spin b) {
  spin r = {FMA(k, a.x, b.x), FMA(k, a.y, b.y), FMA(k, a.z, b.z)};
  return r;
}
static inline REAL spin_component(spin a, const int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}
/* a + c e_axis */
static inline spin spin_along(spin a, const int axis, REAL c) {
  if (axis == 0) a.x = a.x + c;
  if (axis == 1) a.y = a.y + c;
  if (axis == 2) a.z = a.z + c;
  return a;
}
static inline REAL spin_norm2(spin a) { return FMA(a.z, a.z, FMA(a.y, a.y, a.x * a.x)); }
/* n.a: component of a spin along the direction n */
static inline REAL spin_dot(spin a, vec n) { return FMA(a.z, n.z, FMA(a.y, n.y, a.x * n.x)); }
/* t + k n: adds a spin of size k about the direction n */
static inline spin spin_about(REAL k, vec n, spin t) {
  spin r = {FMA(k, n.x, t.x), FMA(k, n.y, t.y), FMA(k, n.z, t.z)};
  return r;
}

/* w x a, the velocity [m/s] of a point at a; then t + w x a */
static inline vec spin_cross(spin w, vec a) {
  vec r = {FMA(w.y, a.z, -(w.z * a.y)), FMA(w.z, a.x, -(w.x * a.z)), FMA(w.x, a.y, -(w.y * a.x))};
  return r;
}
static inline vec spin_cross_add(spin w, vec a, vec t) {
  vec r = {FMA(w.y, a.z, FMA(-w.z, a.y, t.x)), FMA(w.z, a.x, FMA(-w.x, a.z, t.y)),
           FMA(w.x, a.y, FMA(-w.y, a.x, t.z))};
  return r;
}
/* a x f, the moment [N m] of the force f at a; then t + a x f */
static inline spin vec_cross(vec a, vec f) {
  spin r = {FMA(a.y, f.z, -(a.z * f.y)), FMA(a.z, f.x, -(a.x * f.z)), FMA(a.x, f.y, -(a.y * f.x))};
  return r;
}
static inline spin vec_moment(vec a, vec f, spin t) {
  spin r = {FMA(a.y, f.z, FMA(-a.z, f.y, t.x)), FMA(a.z, f.x, FMA(-a.x, f.z, t.y)),
            FMA(a.x, f.y, FMA(-a.y, f.x, t.z))};
  return r;
}
/* t + a x n: adds the turn of the direction n by the spin a */
static inline spin spin_turn(spin a, vec n, spin t) {
  spin r = {FMA(a.y, n.z, FMA(-a.z, n.y, t.x)), FMA(a.z, n.x, FMA(-a.x, n.z, t.y)),
            FMA(a.x, n.y, FMA(-a.y, n.x, t.z))};
  return r;
}
