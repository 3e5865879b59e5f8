/* Vectors in the plane z = const and spins about z, for the models that move in that plane. space.h
 * explains the operations. */

typedef struct {
  REAL x, y;
} vec;
typedef struct {
  REAL z;
} spin;

static inline vec vec_add(vec a, vec b) {
  vec r = {a.x + b.x, a.y + b.y};
  return r;
}
static inline vec vec_sub(vec a, vec b) {
  vec r = {a.x - b.x, a.y - b.y};
  return r;
}
static inline vec vec_scale(REAL k, vec a) {
  vec r = {k * a.x, k * a.y};
  return r;
}
static inline vec vec_axpy(REAL k, vec a, vec b) {
  vec r = {FMA(k, a.x, b.x), FMA(k, a.y, b.y)};
  return r;
}
static inline REAL vec_dot(vec a, vec b) { return FMA(a.y, b.y, a.x * b.x); }
static inline vec vec_along(vec a, const int axis, REAL c) {
  if (axis == 0) a.x = a.x + c;
  if (axis == 1) a.y = a.y + c;
  return a;
}

static inline REAL vec_component(vec a, const int axis) { return axis == 0 ? a.x : a.y; }

static inline spin spin_zero(void) {
  spin r = {SPLAT(0)};
  return r;
}
static inline spin spin_add(spin a, spin b) {
  spin r = {a.z + b.z};
  return r;
}
static inline spin spin_sub(spin a, spin b) {
  spin r = {a.z - b.z};
  return r;
}
static inline spin spin_scale(REAL k, spin a) {
  spin r = {k * a.z};
  return r;
}
static inline spin spin_axpy(REAL k, spin a, spin b) {
  spin r = {FMA(k, a.z, b.z)};
  return r;
}
static inline REAL spin_component(spin a, const int axis) { return axis == 2 ? a.z : SPLAT(0); }
static inline spin spin_along(spin a, const int axis, REAL c) {
  if (axis == 2) a.z = a.z + c;
  return a;
}
static inline REAL spin_norm2(spin a) { return a.z * a.z; }
/* A spin about z has no component along a direction in the plane, so the twist terms vanish. */
static inline REAL spin_dot(spin a, vec n) {
  (void)a;
  (void)n;
  return SPLAT(0);
}
static inline spin spin_about(REAL k, vec n, spin t) {
  (void)k;
  (void)n;
  return t;
}
static inline spin spin_turn(spin a, vec n, spin t) {
  (void)a;
  (void)n;
  return t;
}

static inline vec spin_cross(spin w, vec a) {
  vec r = {-(w.z * a.y), w.z * a.x};
  return r;
}
static inline vec spin_cross_add(spin w, vec a, vec t) {
  vec r = {FMA(-w.z, a.y, t.x), FMA(w.z, a.x, t.y)};
  return r;
}
static inline spin vec_cross(vec a, vec f) {
  spin r = {FMA(a.x, f.y, -(a.y * f.x))};
  return r;
}
static inline spin vec_moment(vec a, vec f, spin t) {
  spin r = {FMA(a.x, f.y, FMA(-a.y, f.x, t.z))};
  return r;
}

/* Turn a vector by +90 degrees, and back by -90 degrees. In the plane, a face on the y axis is a
 * face on the x axis turned by +90 degrees and scaled by the ratio of the edges. The moments follow
 * from turned(a) x f = a x turned_back(f). */
static inline vec vec_turned(vec a) {
  vec r = {-a.y, a.x};
  return r;
}
static inline vec vec_turned_back(vec f) {
  vec r = {f.y, -f.x};
  return r;
}
