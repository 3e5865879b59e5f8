/* Tuples with all components zero, or with one number in all lanes of each component. The host
 * defines COMPONENTS_OF_VEC(act) and COMPONENTS_OF_SPIN(act) besides the words of
 * kernels/algebra/memory.h. */
#define WRENCH_SIZE (VEC_SIZE + SPIN_SIZE)

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
static inline pressure pressure_zero(void) {
  pressure p = {SPLAT(0), SPLAT(0), SPLAT(0), SPLAT(0)};
  return p;
}
static inline exchange no_exchange(void) {
  exchange x = {vec_zero(), spin_zero(), spin_zero()};
  return x;
}
static inline carried nothing_carried(void) {
  carried c = {vec_zero(), spin_zero()};
  return c;
}
