/* One evaluation of each kernel on plain operands (shared subset). The tests compare the results
 * over C++, packs and OpenCL; the microbenchmarks time them. The operands of a case are arrays of
 * REAL. A link case takes element i, then element j (KERNEL_CASES in cases.hpp). */

#define CASE_ELEMENT ((int)(sizeof(element) / sizeof(REAL)))

static inline element case_element(const REAL* in) {
  element e;
  REAL* f = (REAL*)&e;
  for (int n = 0; n < CASE_ELEMENT; ++n) f[n] = in[n];
  return e;
}
static inline void case_exchange(exchange x, REAL* out) {
  const REAL* f = (const REAL*)&x;
  for (int n = 0; n < (int)(sizeof(exchange) / sizeof(REAL)); ++n) out[n] = f[n];
}
static inline paper_law case_paper(void) {
  paper_law law = {SPLAT(0.08), SPLAT(0.04), SPLAT(1e-3), SPLAT(3e-3), SPLAT(2e-3)};
  return law;
}
static inline material_law case_material(void) {
  material_law law = {SPLAT(0.08), SPLAT(0.09), SPLAT(4.0),   SPLAT(6.0),   SPLAT(1.5),
                      SPLAT(0.3),  SPLAT(0.2),  SPLAT(-0.1),  SPLAT(0.05),  SPLAT(-0.02),
                      SPLAT(0.03), SPLAT(0.01), SPLAT(0.002), SPLAT(-0.004)};
  return law;
}
static inline link_pressure case_pressure(void) {
  link_pressure p = {SPLAT(0.7), SPLAT(0.2), SPLAT(-0.3), SPLAT(0.15)};
  return p;
}

#define LINK_CASES(axis_name, axis)                                                                \
  static inline void case_paper_link_##axis_name(const REAL* in, REAL* out) {                      \
    case_exchange(paper_link(case_element(in), case_element(in + CASE_ELEMENT), axis,              \
                             case_paper(), case_paper(), 1, 1),                                    \
                  out);                                                                            \
  }                                                                                                \
  static inline void case_plate_link_##axis_name(const REAL* in, REAL* out) {                      \
    exchange x = paper_link(case_element(in), case_element(in + CASE_ELEMENT), axis, case_paper(), \
                            case_paper(), 0, 1);                                                   \
    x.couple_i = couple_moment(x.couple_i, case_paper(), 0, x.couple_j);                           \
    case_exchange(x, out);                                                                         \
  }                                                                                                \
  static inline void case_undamped_link_##axis_name(const REAL* in, REAL* out) {                   \
    case_exchange(paper_link(case_element(in), case_element(in + CASE_ELEMENT), axis,              \
                             case_paper(), case_paper(), 1, 0),                                    \
                  out);                                                                            \
  }                                                                                                \
  static inline void case_material_link_##axis_name(const REAL* in, REAL* out) {                   \
    case_exchange(material_link(case_element(in), case_element(in + CASE_ELEMENT), axis,           \
                                case_material(), no_pressure(), 1, 0, 0),                          \
                  out);                                                                            \
  }                                                                                                \
  static inline void case_sheared_link_##axis_name(const REAL* in, REAL* out) {                    \
    case_exchange(material_link(case_element(in), case_element(in + CASE_ELEMENT), axis,           \
                                case_material(), no_pressure(), 1, 1, 0),                          \
                  out);                                                                            \
  }                                                                                                \
  static inline void case_pressed_link_##axis_name(const REAL* in, REAL* out) {                    \
    case_exchange(material_link(case_element(in), case_element(in + CASE_ELEMENT), axis,           \
                                case_material(), case_pressure(), 1, 1, 1),                        \
                  out);                                                                            \
  }                                                                                                \
  static inline void case_strain_##axis_name(const REAL* in, REAL* out) {                          \
    *(pressure*)out = link_strain(case_element(in), case_element(in + CASE_ELEMENT), axis,         \
                                  SPLAT(0.08), SPLAT(12.5), 1);                                    \
  }                                                                                                \
  static inline void case_elastic_link_##axis_name(const REAL* in, REAL* out) {                    \
    case_exchange(material_link(case_element(in), case_element(in + CASE_ELEMENT), axis,           \
                                case_material(), no_pressure(), 0, 0, 0),                          \
                  out);                                                                            \
  }
LINK_CASES(x, 0)
LINK_CASES(y, 1)
#if AXES > 2
LINK_CASES(z, 2)
#endif

static inline void case_rotation(const REAL* in, REAL* out) {
  element e = case_element(in);
  *(rotor*)out = rotor_spun(e.q, e.w);
}
static inline void case_rotation_cayley(const REAL* in, REAL* out) {
  element e = case_element(in);
  *(rotor*)out = rotor_cayley(e.q, spin_scale(SPLAT(0.25), e.w));
}
/* in: y, Y_1, Y_2, Y_3 and f of one field */
static inline void case_rk_update(const REAL* in, REAL* out) {
  out[0] = rk_first(in[0], SPLAT(0.01), in[4]);
  REAL t = rk_first(in[1] - in[0], SPLAT(0.005), in[4]);
  t = rk_increment(SPLAT(2), in[2], in[0], t);
  t = rk_increment(SPLAT(1), in[3], in[0], t);
  out[1] = rk_finish(SPLAT(1.0 / 3.0), t, in[0]);
}
/* in: an element (v and w are the velocities that forces see), its acceleration, its angular
 * acceleration, its velocities half a step before */
static inline void case_leapfrog(const REAL* in, REAL* out) {
  element e = case_element(in);
  const int vec_size = (int)(sizeof(vec) / sizeof(REAL)),
            spin_size = (int)(sizeof(spin) / sizeof(REAL));
  const REAL *a = in + CASE_ELEMENT, *before = a + vec_size + spin_size;
  *(leap*)out = leapfrog(e, *(const vec*)before, *(const spin*)(before + vec_size), *(const vec*)a,
                         *(const spin*)(a + vec_size), SPLAT(0.01), SPLAT(0.75), SPLAT(0.00125));
}
static inline void case_stabilization(const REAL* in, REAL* out) {
  element e = case_element(in);
  tie_law tie = {SPLAT(3.0), SPLAT(0.2), SPLAT(0.7), SPLAT(0.05)};
  *(vec*)out = tie_force(e, tie, e.u);
  *(spin*)(out + (int)(sizeof(vec) / sizeof(REAL))) = tie_moment(e, tie, e.w);
}
#ifdef STRESS
/* in: arm and force of one axis, then the stress so far */
static inline void case_stress(const REAL* in, REAL* out) {
  vec arm = {in[0], in[1], in[2]}, force = {in[3], in[4], in[5]};
  stress_tensor none = {in[6], in[7], in[8], in[9], in[10], in[11]};
  stress_tensor s = stress_add(none, arm, force);
  *(stress_tensor*)out = s;
  out[6] = von_mises_squared(s);
}
#endif
#if AXES > 2
/* Euler's equation of an element; its first three numbers serve as the moment. */
static inline void case_euler(const REAL* in, REAL* out) {
  element e = case_element(in);
  spin t = {in[0], in[1], in[2]}, inertia = {SPLAT(2), SPLAT(3), SPLAT(4)},
       inverse = {SPLAT(0.5), SPLAT(1.0 / 3.0), SPLAT(0.25)};
  *(spin*)out = spin_euler(t, e.w, e.q, inertia, inverse);
}
#endif
#undef LINK_CASES
#undef CASE_ELEMENT
