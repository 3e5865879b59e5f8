/* Tuples of the model (vec, spin, rotor, element), and how they move between memory and REALs.
 * Words: W lanes a pack; LOAD(p) and STORE(v, p) at the address of a component. The host defines
 * for VEC, SPIN and ROTOR: COMPONENTS_OF_...(act), EACH_OF_...(act, tuple); and VEC_SIZE,
 * SPIN_SIZE, FIELDS. */
#define WRENCH_SIZE (VEC_SIZE + SPIN_SIZE)

#define READ(c) c = LOAD(p), p += W;
#define WRITE(c) STORE(c, p), p += W;
static inline element element_at(global const NUMBER* p) {
  element e;
  EACH_OF_VEC(READ, e.u)
  EACH_OF_VEC(READ, e.v)
  EACH_OF_ROTOR(READ, e.q)
  EACH_OF_SPIN(READ, e.w)
  return e;
}
static inline vec vec_at(global const NUMBER* p) {
  vec a;
  EACH_OF_VEC(READ, a)
  return a;
}
static inline spin spin_at(global const NUMBER* p) {
  spin a;
  EACH_OF_SPIN(READ, a)
  return a;
}
static inline void put_vec(vec a, global NUMBER* p) { EACH_OF_VEC(WRITE, a) }
static inline void put_spin(spin a, global NUMBER* p) { EACH_OF_SPIN(WRITE, a) }
static inline void put_rotor(rotor a, global NUMBER* p) { EACH_OF_ROTOR(WRITE, a) }

static inline vec vec_zero(void) {
  vec a;
#define CLEAR(c) c = SPLAT(0);
  EACH_OF_VEC(CLEAR, a)
  return a;
}
#define PLACE_x 0
#define PLACE_y 1
#define PLACE_z 2
#define SPLAT_COMPONENT(c) a.c = SPLAT(xyz[PLACE_##c]);
static inline vec vec_splat(global const NUMBER* xyz) {
  vec a;
  COMPONENTS_OF_VEC(SPLAT_COMPONENT)
  return a;
}
static inline spin spin_splat(global const NUMBER* xyz) {
  spin a = spin_zero();
  COMPONENTS_OF_SPIN(SPLAT_COMPONENT)
  return a;
}
static inline exchange no_exchange(void) {
  exchange x = {vec_zero(), spin_zero(), spin_zero()};
  return x;
}
static inline carried nothing_carried(void) {
  carried c = {vec_zero(), spin_zero()};
  return c;
}

/* Adds 0 * x for every component: 0 unless x is infinite or NaN. Costs one multiply-add each. */
#define ADD_ZERO(c) sum = FMA(c, SPLAT(0), sum);
static inline REAL finite_check(vec v, spin w, REAL sum) {
  EACH_OF_VEC(ADD_ZERO, v)
  EACH_OF_SPIN(ADD_ZERO, w)
  return sum;
}
