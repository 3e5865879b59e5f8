/* Tuples of the model (vec, spin, rotor, element) in memory (shared subset). Words besides those of
 * the algebra:
 *   NUMBER, GLOBAL               a stored number; its address space
 *   W                            numbers from a component of a tuple to the next
 *   LOAD(p), STORE(v, p)         a REAL from memory, and to memory
 *   EACH_OF_VEC(act, t), ...     act(c) for each component of a vec, rotor or spin
 *   VEC_SIZE, SPIN_SIZE, FIELDS  numbers of components */
#define READ(c) c = LOAD(p), p += W;
#define WRITE(c) STORE(c, p), p += W;
static inline element element_at(GLOBAL const NUMBER* p) {
  element e;
  EACH_OF_VEC(READ, e.u)
  EACH_OF_VEC(READ, e.v)
  EACH_OF_ROTOR(READ, e.q)
  EACH_OF_SPIN(READ, e.w)
  return e;
}
static inline vec vec_at(GLOBAL const NUMBER* p) {
  vec a;
  EACH_OF_VEC(READ, a)
  return a;
}
static inline spin spin_at(GLOBAL const NUMBER* p) {
  spin a = spin_zero();
  EACH_OF_SPIN(READ, a)
  return a;
}
static inline void put_vec(vec a, GLOBAL NUMBER* p) { EACH_OF_VEC(WRITE, a) }
static inline void put_spin(spin a, GLOBAL NUMBER* p) { EACH_OF_SPIN(WRITE, a) }
static inline void put_rotor(rotor a, GLOBAL NUMBER* p) { EACH_OF_ROTOR(WRITE, a) }

/* Places of fields in a pack. Velocities of the half step, if any, follow the fields. */
#define V_AT (VEC_SIZE * W)
#define Q_AT (2 * VEC_SIZE * W)
#define W_AT ((FIELDS - SPIN_SIZE) * W)
#define V_HALF_AT (FIELDS * W)
#define W_HALF_AT ((FIELDS + VEC_SIZE) * W)

/* Adds 0 * x for every component: 0 unless x is infinite or NaN. Costs one multiply-add each. */
#define ADD_ZERO(c) sum = FMA(c, SPLAT(0), sum);
static inline REAL finite_check(vec v, spin w, REAL sum) {
  EACH_OF_VEC(ADD_ZERO, v)
  EACH_OF_SPIN(ADD_ZERO, w)
  return sum;
}
#undef READ
#undef WRITE
#undef ADD_ZERO
