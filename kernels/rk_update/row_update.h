/* What each action of a row (enum row_action) does with the force and the turn of a pack (shared
 * subset). It needs the laws (kernels/laws.h), kernels/algebra/memory.h and these words:
 *   ROW                        a row
 *   TASK(row)                  the task of a row: RowTask, or row_stage of a device
 *   PLACE(row, p)              the address of what a task calls p
 *   IF_ACTION(k, action)       code for an action; left out if these rows do not have it
 *   STORE_EARLY, STORE_LATE    one of them is STORE, the other does nothing: results are stored as
 *                              soon as they are known, or after all loads */

/* The constants of a row's update. The last four are those of a leapfrog. */
typedef struct {
  ROW row;
  int action, is_last;
  long low; /* compensated: distance from a number to its low part or increment */
  GLOBAL const NUMBER *base, *increment[3];
  GLOBAL NUMBER* out;
  REAL alpha[3], beta_u, beta_v, beta_q, beta_w; /* beta: factors from rates to increments */
  REAL smoothing, ahead, inverse_mass, turn_scale;
} row_update;

/* @param beta        that of the task; on devices times the length of the step, which is 1 unless
 *                    the method has an error stage
 * @param turn_scale  w' divided by turn */
static inline row_update update_of_row(ROW row, REAL beta, REAL inverse_mass, REAL turn_scale) {
  row_update k = {
      row,
      TASK(row)->action,
      TASK(row)->is_last,
      TASK(row)->low,
      PLACE(row, TASK(row)->base),
      {PLACE(row, TASK(row)->increment[0]), PLACE(row, TASK(row)->increment[1]),
       PLACE(row, TASK(row)->increment[2])},
      PLACE(row, TASK(row)->out),
      {SPLAT(TASK(row)->alpha[0]), SPLAT(TASK(row)->alpha[1]), SPLAT(TASK(row)->alpha[2])},
      beta,
      beta * inverse_mass,
      beta * SPLAT((NUMBER)0.5),
      beta * turn_scale,
      SPLAT(TASK(row)->alpha[0]),
      SPLAT(TASK(row)->alpha[1]) * beta,
      inverse_mass,
      turn_scale};
  return k;
}

/* Runge-Kutta stages. `at` is the place of a component in a row. */
static inline REAL increments_of(row_update k, const long at, REAL y, REAL beta, REAL rate) {
  REAL t = rk_first(LOAD(PLACE(k.row, TASK(k.row)->increment[0]) + at) - y, beta, rate);
  for (int m = 1; m < TASK(k.row)->increments; ++m)
    t = rk_increment(SPLAT(TASK(k.row)->alpha[m]),
                     LOAD(PLACE(k.row, TASK(k.row)->increment[m]) + at), y, t);
  return t;
}
/* Unused places repeat the first increment, with the ratio 0. */
static inline REAL kept_of_three(row_update k, const long at, REAL beta, REAL rate) {
  REAL t = kept_first(LOAD(k.increment[0] + k.low + at), beta, rate);
  t = kept_later(k.alpha[1], LOAD(k.increment[1] + k.low + at), t);
  return k.alpha[0] * kept_later(k.alpha[2], LOAD(k.increment[2] + k.low + at), t);
}
static inline REAL kept_of_many(row_update k, const long at, REAL beta, REAL rate) {
  REAL t = kept_first(LOAD(k.increment[0] + k.low + at), beta, rate);
  for (int m = 1; m < TASK(k.row)->increments; ++m)
    t = kept_later(SPLAT(TASK(k.row)->alpha[m]),
                   LOAD(PLACE(k.row, TASK(k.row)->increment[m]) + k.low + at), t);
  return k.alpha[0] * t;
}
/* Stores the increment d behind the field. The last stage stores the state's low part instead.
 * @return the new value of the field */
static inline REAL kept_sum(row_update k, const int is_step, const long at, REAL d) {
  const REAL y = LOAD(k.base + at), s = LOAD(k.base + k.low + at) + d, sum = y + s;
  STORE(is_step ? lost_of_sum(y, s, sum) : d, k.out + k.low + at);
  return sum;
}

/* A component c becomes its new value, from its rate. The macros use k, at, e, beta, is_step and
 * next_u to next_w of the function below. */
#define DONE(c) STORE_EARLY(c, k.out + at), at += W;
#define ADVANCE(c) c = rk_first(LOAD(k.base + at), beta, c), DONE(c)
#define COMBINE(c)                                                                                 \
  c = rk_combined(LOAD(k.base + at), beta, c, LOAD(k.increment[0] + at),                           \
                  LOAD(k.increment[1] + at), LOAD(k.increment[2] + at), k.alpha[0], k.alpha[1],    \
                  k.alpha[2]),                                                                     \
  DONE(c)
#define COMBINE_MANY(c)                                                                            \
  {                                                                                                \
    const REAL y = LOAD(k.base + at);                                                              \
    c = rk_finish(k.alpha[0], increments_of(k, at, y, beta, c), y), DONE(c)                        \
  }
#define ESTIMATE(c)                                                                                \
  c = rk_estimate(k.alpha[0], increments_of(k, at, LOAD(k.base + at), beta, c)), DONE(c)
#define KEEP_FIRST(c) c = kept_sum(k, is_step, at, beta * c), DONE(c)
#define KEEP_THREE(c) c = kept_sum(k, is_step, at, kept_of_three(k, at, beta, c)), DONE(c)
#define KEEP_MANY(c) c = kept_sum(k, is_step, at, kept_of_many(k, at, beta, c)), DONE(c)
#define KEEP_ESTIMATE(c) c = kept_of_many(k, at, beta, c), DONE(c)

/* Calls act(c) for every component of the rates. `beta` is the factor from a rate to its
 * increment. The rate of q is computed late, because registers are few. */
#define EACH_WITH(factor, each, act, t)                                                            \
  {                                                                                                \
    const REAL beta = factor;                                                                      \
    each(act, t)                                                                                   \
  }
#define EACH_RATE(act)                                                                             \
  EACH_WITH(k.beta_u, EACH_OF_VEC, act, next_u)                                                    \
  EACH_WITH(k.beta_v, EACH_OF_VEC, act, next_v)                                                    \
  next_q = rotor_spun(e.q, e.w);                                                                   \
  EACH_WITH(k.beta_q, EACH_OF_ROTOR, act, next_q)                                                  \
  EACH_WITH(k.beta_w, EACH_OF_SPIN, act, next_w)
#define EACH_KEPT                                                                                  \
  if (TASK(k.row)->increments == 0) {                                                              \
    EACH_RATE(KEEP_FIRST)                                                                          \
  } else if (TASK(k.row)->increments <= 3) {                                                       \
    EACH_RATE(KEEP_THREE)                                                                          \
  } else {                                                                                         \
    EACH_RATE(KEEP_MANY)                                                                           \
  }
#define STORED_LATE(c) STORE_LATE(c, k.out + at), at += W;

static inline REAL runge_kutta_update(row_update k, const long place, element e, vec force,
                                      spin turn, REAL check) {
  long at = place;
  vec next_u = e.v, next_v = force;
  rotor next_q = e.q;
  spin next_w = turn;
  IF_ACTION (k, plain_stage) {
    EACH_RATE(ADVANCE)
  }
  IF_ACTION (k, combined_stage) {
    EACH_RATE(COMBINE)
  }
  IF_ACTION (k, wide_stage) {
    EACH_RATE(COMBINE_MANY)
  }
  IF_ACTION (k, error_stage) {
    EACH_RATE(ESTIMATE)
  }
  IF_ACTION (k, kept_error) {
    EACH_RATE(KEEP_ESTIMATE)
  }
  IF_ACTION (k, kept_stage) {
    const int is_step = 0;
    EACH_KEPT
  }
  IF_ACTION (k, kept_step) {
    const int is_step = 1;
    EACH_KEPT
  }
  if (at == place) { /* an action without code */
    STORE(SPLAT((NUMBER)NAN), k.out + place);
    return SPLAT((NUMBER)NAN);
  }
  at = place;
  EACH_OF_VEC(STORED_LATE, next_u)
  EACH_OF_VEC(STORED_LATE, next_v)
  EACH_OF_ROTOR(STORED_LATE, next_q)
  EACH_OF_SPIN(STORED_LATE, next_w)
  if (k.is_last) check = finite_check(next_v, next_w, check);
  return check;
}

/* One leapfrog step. If forces depend on velocities (is_predicted), the fields v and w of a row
 * hold the prediction p that the links see, and the half-step velocities follow the pack's fields.
 * Otherwise v and w are the half-step velocities. */
static inline REAL leapfrog_update(row_update k, const int is_predicted, const long place,
                                   element e, vec force, spin turn, REAL check) {
  GLOBAL const NUMBER* const in = k.base + place;
  GLOBAL NUMBER* const out = k.out + place;
  vec v_half = e.v;
  spin w_half = e.w;
  if (is_predicted) v_half = vec_at(in + V_HALF_AT), w_half = spin_at(in + W_HALF_AT);
  const leap next = leapfrog(e, v_half, w_half, vec_scale(k.inverse_mass, force),
                             spin_scale(k.turn_scale, turn), k.beta_u, k.smoothing, k.ahead);
  put_vec(next.u, out);
  put_vec(is_predicted ? next.v_next : next.v_half, out + V_AT);
  put_rotor(next.q, out + Q_AT);
  put_spin(is_predicted ? next.w_next : next.w_half, out + W_AT);
  if (is_predicted) {
    put_vec(next.v_half, out + V_HALF_AT);
    put_spin(next.w_half, out + W_HALF_AT);
  }
  /* The Cayley map squares its argument, so q may overflow before w does. */
  check = finite_check(next.v_half, next.w_half, check);
  return FMA(rotor_sign_of_life(next.q), SPLAT(0), check);
}

/* c becomes y + (low + c), with y at `from`. Stores the new low part at `low_out`. Moves all three
 * to the next component. */
#define SUM_UP(c)                                                                                  \
  {                                                                                                \
    const REAL s = LOAD(low) + c, y = LOAD(from), sum = y + s;                                     \
    STORE(lost_of_sum(y, s, sum), low_out);                                                        \
    c = sum, from += W, low += W, low_out += W;                                                    \
  }
#define SUM_UP_ALL(each, t, value_at, low_at)                                                      \
  from = in + (value_at), low = in + k.low + (low_at), low_out = out + k.low + (low_at);           \
  each(SUM_UP, t)
/* Leapfrog step with compensated sums. The low parts of u, v, q and w follow all other numbers of
 * the pack, in the order of the fields; those of v and w belong to the half-step velocities. */
static inline REAL kept_leapfrog_update(row_update k, const int is_predicted, const long place,
                                        element e, vec force, spin turn, REAL check) {
  GLOBAL const NUMBER *const in = k.base + place, *from, *low;
  GLOBAL NUMBER *const out = k.out + place, *low_out;
  vec v_half = e.v;
  spin w_half = e.w;
  if (is_predicted) v_half = vec_at(in + V_HALF_AT), w_half = spin_at(in + W_HALF_AT);
  const vec a = vec_scale(k.inverse_mass, force);
  const spin alpha = spin_scale(k.turn_scale, turn);
  vec v = vec_scale(k.beta_u, a);
  spin w = spin_scale(k.beta_u, alpha);
  SUM_UP_ALL(EACH_OF_VEC, v, is_predicted ? V_HALF_AT : V_AT, V_AT)
  SUM_UP_ALL(EACH_OF_SPIN, w, is_predicted ? W_HALF_AT : W_AT, W_AT)
  vec x = vec_scale(k.beta_u, v);
  SUM_UP_ALL(EACH_OF_VEC, x, 0, 0)
  rotor q = rotor_cayley_change(e.q, spin_scale(SPLAT(0.25) * k.beta_u, w));
  SUM_UP_ALL(EACH_OF_ROTOR, q, Q_AT, Q_AT)
  put_vec(x, out);
  put_vec(is_predicted ? vec_predicted(e.v, v_half, v, a, k.smoothing, k.ahead) : v, out + V_AT);
  put_rotor(q, out + Q_AT);
  put_spin(is_predicted ? spin_predicted(e.w, w_half, w, alpha, k.smoothing, k.ahead) : w,
           out + W_AT);
  if (is_predicted) put_vec(v, out + V_HALF_AT), put_spin(w, out + W_HALF_AT);
  check = finite_check(v, w, check);
  return FMA(rotor_sign_of_life(q), SPLAT(0), check);
}

/* @param place  offset of a pack in its row
 * @return `check` plus 0, or plus NaN if a result that must be finite is not */
static inline REAL updated(row_update k, const long place, element e, vec force, spin turn,
                           REAL check) {
  IF_ACTION (k, bare_rates) {
    GLOBAL NUMBER* const out = k.out + place;
    put_vec(e.v, out);
    put_vec(force, out + V_AT);
    put_rotor(rotor_spun(e.q, e.w), out + Q_AT);
    put_spin(turn, out + W_AT);
    return check;
  }
  IF_ACTION (k, leapfrog_step) return leapfrog_update(k, 0, place, e, force, turn, check);
  IF_ACTION (k, predicted_step) return leapfrog_update(k, 1, place, e, force, turn, check);
  IF_ACTION (k, kept_leapfrog) return kept_leapfrog_update(k, 0, place, e, force, turn, check);
  IF_ACTION (k, kept_predicted) return kept_leapfrog_update(k, 1, place, e, force, turn, check);
  return runge_kutta_update(k, place, e, force, turn, check);
}

#undef DONE
#undef ADVANCE
#undef COMBINE
#undef COMBINE_MANY
#undef ESTIMATE
#undef KEEP_FIRST
#undef KEEP_THREE
#undef KEEP_MANY
#undef KEEP_ESTIMATE
#undef EACH_WITH
#undef EACH_RATE
#undef EACH_KEPT
#undef STORED_LATE
#undef SUM_UP
#undef SUM_UP_ALL
