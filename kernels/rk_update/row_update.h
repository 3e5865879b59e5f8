/* What each action of a row (kernels/stage_row/row_action.h) does with the force and the turn of a
 * pack (shared subset; formulas: rk_update.h). It needs words besides those of the algebra and of
 * kernels/algebra/memory.h:
 *   ROW                         a row: TASK(row) is its task, PLACE(row, p) an address in memory
 *   IF_ACTION(u, action)        code for an action; left out if these rows do not have it
 *   STORE_EARLY, STORE_LATE     one of them is STORE, the other does nothing: results are stored as
 *                               soon as they are known, or after all loads */

/* The constants of a row's update. The last four are those of a leapfrog. */
typedef struct {
  ROW row;
  int action, is_last;
  long low; /* compensated: distance from a number to its low part or increment */
  GLOBAL const NUMBER *base, *increment[3];
  GLOBAL NUMBER* out;
  REAL alpha[3], beta_u, beta_v, beta_q, beta_w; /* beta: factors from rates to increments */
  REAL smoothing, ahead, inverse_mass;
  NUMBER turn_scale;
} row_update;

/* @param beta        that of the task, times the length of the step if the task does not have it
 * @param turn_scale  w' divided by turn */
static inline row_update update_of_row(ROW row, NUMBER beta, NUMBER inverse_mass,
                                       NUMBER turn_scale) {
  row_update u = {
      row,
      TASK(row)->action,
      TASK(row)->is_last,
      TASK(row)->low,
      PLACE(row, TASK(row)->base),
      {PLACE(row, TASK(row)->increment[0]), PLACE(row, TASK(row)->increment[1]),
       PLACE(row, TASK(row)->increment[2])},
      PLACE(row, TASK(row)->out),
      {SPLAT(TASK(row)->alpha[0]), SPLAT(TASK(row)->alpha[1]), SPLAT(TASK(row)->alpha[2])},
      SPLAT(beta),
      SPLAT(beta * inverse_mass),
      SPLAT(beta * (NUMBER)0.5),
      SPLAT(beta * turn_scale),
      SPLAT(TASK(row)->alpha[0]),
      SPLAT(TASK(row)->alpha[1] * beta),
      SPLAT(inverse_mass),
      turn_scale};
  return u;
}

/* Runge-Kutta stages. `at` is the place of a component in a row. */
static inline REAL increments_of(row_update u, const long at, REAL y, REAL beta, REAL rate) {
  REAL t = rk_first(LOAD(PLACE(u.row, TASK(u.row)->increment[0]) + at) - y, beta, rate);
  for (int m = 1; m < TASK(u.row)->increments; ++m)
    t = rk_increment(SPLAT(TASK(u.row)->alpha[m]),
                     LOAD(PLACE(u.row, TASK(u.row)->increment[m]) + at), y, t);
  return t;
}
static inline REAL kept_of_three(row_update u, const long at, REAL beta, REAL rate) {
  REAL t = kept_first(LOAD(u.increment[0] + u.low + at), beta, rate);
  t = kept_later(u.alpha[1], LOAD(u.increment[1] + u.low + at), t);
  return u.alpha[0] * kept_later(u.alpha[2], LOAD(u.increment[2] + u.low + at), t);
}
static inline REAL kept_of_many(row_update u, const long at, REAL beta, REAL rate) {
  REAL t = kept_first(LOAD(u.increment[0] + u.low + at), beta, rate);
  for (int m = 1; m < TASK(u.row)->increments; ++m)
    t = kept_later(SPLAT(TASK(u.row)->alpha[m]),
                   LOAD(PLACE(u.row, TASK(u.row)->increment[m]) + u.low + at), t);
  return u.alpha[0] * t;
}
/* Stores the increment d behind the field. The last stage stores the state's low part instead.
 * @return the new value of the field */
static inline REAL kept_sum(row_update u, const int is_step, const long at, REAL d) {
  const REAL y = LOAD(u.base + at), s = LOAD(u.base + u.low + at) + d, sum = y + s;
  STORE(is_step ? lost_of_sum(y, s, sum) : d, u.out + u.low + at);
  return sum;
}

/* A component c becomes its new value, from its rate. */
#define DONE(c) STORE_EARLY(c, u.out + at), at += W;
#define ADVANCE(c) c = rk_first(LOAD(u.base + at), beta, c), DONE(c)
#define COMBINE(c)                                                                                 \
  c = rk_combined(LOAD(u.base + at), beta, c, LOAD(u.increment[0] + at),                           \
                  LOAD(u.increment[1] + at), LOAD(u.increment[2] + at), u.alpha[0], u.alpha[1],    \
                  u.alpha[2]),                                                                     \
  DONE(c)
#define COMBINE_MANY(c)                                                                            \
  {                                                                                                \
    const REAL y = LOAD(u.base + at);                                                              \
    c = rk_finish(u.alpha[0], increments_of(u, at, y, beta, c), y), DONE(c)                        \
  }
#define ESTIMATE(c)                                                                                \
  c = rk_estimate(u.alpha[0], increments_of(u, at, LOAD(u.base + at), beta, c)), DONE(c)
#define KEEP_FIRST(c) c = kept_sum(u, is_step, at, beta * c), DONE(c)
#define KEEP_THREE(c) c = kept_sum(u, is_step, at, kept_of_three(u, at, beta, c)), DONE(c)
#define KEEP_MANY(c) c = kept_sum(u, is_step, at, kept_of_many(u, at, beta, c)), DONE(c)
#define KEEP_ESTIMATE(c) c = kept_of_many(u, at, beta, c), DONE(c)

/* Calls act(c) for every component of the rates. `beta` is the factor from a rate to its
 * increment. */
#define EACH_WITH(factor, each, act, t)                                                            \
  {                                                                                                \
    const REAL beta = factor;                                                                      \
    each(act, t)                                                                                   \
  }
#define EACH_RATE(act)                                                                             \
  EACH_WITH(u.beta_u, EACH_OF_VEC, act, next_u)                                                    \
  EACH_WITH(u.beta_v, EACH_OF_VEC, act, next_v)                                                    \
  next_q = rotor_spun(e.q, e.w);                                                                   \
  EACH_WITH(u.beta_q, EACH_OF_ROTOR, act, next_q)                                                  \
  EACH_WITH(u.beta_w, EACH_OF_SPIN, act, next_w)
#define EACH_KEPT                                                                                  \
  if (TASK(u.row)->increments == 0) {                                                              \
    EACH_RATE(KEEP_FIRST)                                                                          \
  } else if (TASK(u.row)->increments <= 3) {                                                       \
    EACH_RATE(KEEP_THREE)                                                                          \
  } else {                                                                                         \
    EACH_RATE(KEEP_MANY)                                                                           \
  }
#define STORED_LATE(c) STORE_LATE(c, u.out + at), at += W;

static inline REAL runge_kutta_update(row_update u, const long place, element e, vec force,
                                      spin turn, REAL check) {
  long at = place;
  vec next_u = e.v, next_v = force;
  rotor next_q = e.q;
  spin next_w = turn;
  IF_ACTION (u, plain_stage) {
    EACH_RATE(ADVANCE)
  }
  IF_ACTION (u, combined_stage) {
    EACH_RATE(COMBINE)
  }
  IF_ACTION (u, wide_stage) {
    EACH_RATE(COMBINE_MANY)
  }
  IF_ACTION (u, error_stage) {
    EACH_RATE(ESTIMATE)
  }
  IF_ACTION (u, kept_error) {
    EACH_RATE(KEEP_ESTIMATE)
  }
  IF_ACTION (u, kept_stage) {
    const int is_step = 0;
    EACH_KEPT
  }
  IF_ACTION (u, kept_step) {
    const int is_step = 1;
    EACH_KEPT
  }
  at = place;
  EACH_OF_VEC(STORED_LATE, next_u)
  EACH_OF_VEC(STORED_LATE, next_v)
  EACH_OF_ROTOR(STORED_LATE, next_q)
  EACH_OF_SPIN(STORED_LATE, next_w)
  if (u.is_last) check = finite_check(next_v, next_w, check);
  return check;
}

/* One step in place. If forces depend on velocities (is_predicted), the fields v and w of a row
 * hold the prediction p that the links see, and the half-step velocities follow the pack's fields.
 * Otherwise v and w are the half-step velocities. */
static inline REAL leapfrog_update(row_update u, const int is_predicted, const long place,
                                   element e, vec force, spin turn, REAL check) {
  GLOBAL const NUMBER* const in = u.base + place;
  GLOBAL NUMBER* const out = u.out + place;
  vec v_half = e.v;
  spin w_half = e.w;
  if (is_predicted) v_half = vec_at(in + V_HALF_AT), w_half = spin_at(in + W_HALF_AT);
  const leap next = leapfrog(e, v_half, w_half, vec_scale(u.inverse_mass, force),
                             spin_scale(SPLAT(u.turn_scale), turn), u.beta_u, u.smoothing, u.ahead);
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

/* The value y at `from` and its low part at `low` become the sum y + (low + c), which c becomes,
 * too. */
#define SUM_UP(c)                                                                                  \
  {                                                                                                \
    const REAL s = LOAD(low) + c, y = LOAD(from), sum = y + s;                                     \
    STORE(lost_of_sum(y, s, sum), low_out);                                                        \
    c = sum, from += W, low += W, low_out += W;                                                    \
  }
#define SUM_UP_ALL(each, t, value_at, low_at)                                                      \
  from = in + (value_at), low = in + u.low + (low_at), low_out = out + u.low + (low_at);           \
  each(SUM_UP, t)
/* Leapfrog step with compensated sums. The low parts of u, v, q and w follow all other numbers of
 * the pack, in the order of the fields; those of v and w belong to the half-step velocities. */
static inline REAL kept_leapfrog_update(row_update u, const int is_predicted, const long place,
                                        element e, vec force, spin turn, REAL check) {
  GLOBAL const NUMBER *const in = u.base + place, *from, *low;
  GLOBAL NUMBER *const out = u.out + place, *low_out;
  vec v_half = e.v;
  spin w_half = e.w;
  if (is_predicted) v_half = vec_at(in + V_HALF_AT), w_half = spin_at(in + W_HALF_AT);
  const vec a = vec_scale(u.inverse_mass, force);
  const spin alpha = spin_scale(SPLAT(u.turn_scale), turn);
  vec v = vec_scale(u.beta_u, a);
  spin w = spin_scale(u.beta_u, alpha);
  SUM_UP_ALL(EACH_OF_VEC, v, is_predicted ? V_HALF_AT : V_AT, V_AT)
  SUM_UP_ALL(EACH_OF_SPIN, w, is_predicted ? W_HALF_AT : W_AT, W_AT)
  vec x = vec_scale(u.beta_u, v);
  SUM_UP_ALL(EACH_OF_VEC, x, 0, 0)
  rotor q = rotor_cayley_change(e.q, spin_scale(SPLAT(0.25) * u.beta_u, w));
  SUM_UP_ALL(EACH_OF_ROTOR, q, Q_AT, Q_AT)
  put_vec(x, out);
  put_vec(is_predicted ? vec_predicted(e.v, v_half, v, a, u.smoothing, u.ahead) : v, out + V_AT);
  put_rotor(q, out + Q_AT);
  put_spin(is_predicted ? spin_predicted(e.w, w_half, w, alpha, u.smoothing, u.ahead) : w,
           out + W_AT);
  if (is_predicted) put_vec(v, out + V_HALF_AT), put_spin(w, out + W_HALF_AT);
  check = finite_check(v, w, check);
  return FMA(rotor_sign_of_life(q), SPLAT(0), check);
}

/* @param place  offset of a pack in its row
 * @return `check` plus 0, or plus NaN if a result that must be finite is not */
static inline REAL updated(row_update u, const long place, element e, vec force, spin turn,
                           REAL check) {
  IF_ACTION (u, bare_rates) {
    GLOBAL NUMBER* const out = u.out + place;
    put_vec(e.v, out);
    put_vec(force, out + V_AT);
    put_rotor(rotor_spun(e.q, e.w), out + Q_AT);
    put_spin(turn, out + W_AT);
    return check;
  }
  IF_ACTION (u, leapfrog_step) return leapfrog_update(u, 0, place, e, force, turn, check);
  IF_ACTION (u, predicted_step) return leapfrog_update(u, 1, place, e, force, turn, check);
  IF_ACTION (u, kept_leapfrog) return kept_leapfrog_update(u, 0, place, e, force, turn, check);
  IF_ACTION (u, kept_predicted) return kept_leapfrog_update(u, 1, place, e, force, turn, check);
  return runge_kutta_update(u, place, e, force, turn, check);
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
