/* Algebra of the axial model (shared subset). Elements are linked along x, move along x and do not
 * turn. A vector has only the component x. Spins and rotors have no components. They hold one
 * number that nothing reads, because C has no empty struct. space.h and spatial.h explain the
 * operations. */
#define AXES 1
#define LINEAR

typedef struct {
  REAL x;
} vec;
typedef struct {
  int none;
} spin;
typedef spin rotor;

static inline vec vec_add(vec a, vec b) {
  vec r = {a.x + b.x};
  return r;
}
static inline vec vec_sub(vec a, vec b) {
  vec r = {a.x - b.x};
  return r;
}
static inline vec vec_scale(REAL k, vec a) {
  vec r = {k * a.x};
  return r;
}
static inline vec vec_axpy(REAL k, vec a, vec b) {
  vec r = {FMA(k, a.x, b.x)};
  return r;
}

static inline vec vec_along(vec a, const int axis, REAL c) {
  if (axis == 0) a.x = a.x + c;
  return a;
}
static inline REAL vec_component(vec a, const int axis) { return axis == 0 ? a.x : SPLAT(0); }

static inline spin spin_zero(void) {
  spin r = {0};
  return r;
}
static inline REAL spin_component(spin a, const int axis) {
  (void)a;
  (void)axis;
  return SPLAT(0);
}
static inline spin spin_along(spin a, const int axis, REAL c) {
  (void)axis;
  (void)c;
  return a;
}
static inline spin spin_add(spin a, spin b) {
  (void)b;
  return a;
}
static inline spin spin_sub(spin a, spin b) {
  (void)b;
  return a;
}
static inline spin spin_scale(REAL k, spin a) {
  (void)k;
  return a;
}
static inline spin spin_axpy(REAL k, spin a, spin b) {
  (void)k;
  (void)a;
  return b;
}

static inline vec rotor_turn(rotor q, const int axis, REAL edge) {
  (void)q;
  (void)axis;
  (void)edge;
  vec r = {SPLAT(0)};
  return r;
}
typedef spin lever; /* the lever is parallel to the force: no moment */
static inline lever lever_of(vec turn, const int axis, REAL half_edge) {
  (void)turn;
  (void)axis;
  (void)half_edge;
  return spin_zero();
}
static inline vec lever_rate(spin w, lever a, const int axis, vec t) {
  (void)w;
  (void)a;
  (void)axis;
  return t;
}
static inline spin lever_moment(lever a, const int axis, vec f, spin t) {
  (void)a;
  (void)axis;
  (void)f;
  return t;
}
static inline spin lever_cross(lever a, const int axis, vec f) {
  return lever_moment(a, axis, f, spin_zero());
}

static inline vec vec_principal(vec a, const int axis, REAL across, REAL along) {
  vec r = {axis == 0 ? FMA(along, a.x, across * a.x) : across * a.x};
  return r;
}
/* There is no axis across. */
static inline vec vec_axpy_along(REAL k, vec a, const int axis, vec r) {
  (void)k, (void)a, (void)axis;
  return r;
}
static inline spin spin_principal(spin a, REAL z, REAL xz, REAL yz) {
  (void)z;
  (void)xz;
  (void)yz;
  return a;
}

static inline spin rotor_relative(rotor i, rotor j) {
  (void)i;
  return j;
}
static inline spin rotor_vector(rotor q) { return q; }
static inline REAL rotor_sign_of_life(rotor q) {
  (void)q;
  return SPLAT(0);
}
static inline rotor rotor_spun(rotor q, spin w) {
  (void)q;
  return w;
}
static inline rotor rotor_cayley_change(rotor q, spin b) {
  (void)q;
  return b;
}
static inline rotor rotor_cayley(rotor q, spin b) {
  (void)b;
  return q;
}
static inline spin spin_euler(spin t, spin w, rotor q, spin inertia, spin inverse_inertia) {
  (void)w;
  (void)q;
  (void)inertia;
  (void)inverse_inertia;
  return t;
}
