/* What a stage does with the forces and the angular accelerations of a pack, as in
 * kernels/rk_update/update.hpp. HAS(action) is constant: whether rows of this program have the
 * action. */

/* Calls act on every component of the rates. `beta` is the factor from a rate to its increment. */
#define NEXT(factor, each, act, t) \
  {                                \
    const REAL beta = factor;      \
    each(act, t)                   \
  }
#define EACH_NEXT(act)                                    \
  NEXT(SPLAT(h), EACH_OF_VEC, act, next_u)                \
  NEXT(SPLAT(h) * inverse_mass, EACH_OF_VEC, act, next_v) \
  NEXT(SPLAT(h * (NUMBER)0.5), EACH_OF_ROTOR, act, next_q)  \
  NEXT(SPLAT(h) * turn_scale, EACH_OF_SPIN, act, next_w)

static inline REAL increments(device d, global const row_stage* task, const long at, REAL y,
                              REAL beta, REAL rate) {
  REAL t = rk_first(LOAD(d.arena + task->increment[0] + at) - y, beta, rate);
  for (int m = 1; m < task->increments; ++m)
    t = rk_increment(SPLAT(task->alpha[m]), LOAD(d.arena + task->increment[m] + at), y, t);
  return t;
}
static inline REAL wide_sum(device d, global const row_stage* task, const long at, REAL y,
                            REAL beta, REAL rate) {
  return rk_finish(SPLAT(task->alpha[0]), increments(d, task, at, y, beta, rate), y);
}
static inline REAL estimate(device d, global const row_stage* task, const long at, REAL y,
                            REAL beta, REAL rate) {
  return rk_estimate(SPLAT(task->alpha[0]), increments(d, task, at, y, beta, rate));
}

static inline REAL kept_increment(device d, global const row_stage* task, const long at, REAL beta,
                                  REAL rate) {
  const int low = task->low;
  if (task->increments == 0) return beta * rate;
  REAL t = kept_first(LOAD(d.arena + task->increment[0] + low + at), beta, rate);
  for (int m = 1; m < task->increments; ++m)
    t = kept_later(SPLAT(task->alpha[m]), LOAD(d.arena + task->increment[m] + low + at), t);
  return SPLAT(task->alpha[0]) * t;
}
/* Stores the increment behind the field, or the low part of the state in a last stage.
 * @return the sum */
static inline REAL kept_sum(device d, global const row_stage* task, const long at, REAL beta,
                            REAL rate) {
  const int low = task->low;
  const REAL t = kept_increment(d, task, at, beta, rate);
  const REAL y = LOAD(d.arena + task->base + at), s = LOAD(d.arena + task->base + low + at) + t,
             sum = y + s;
  STORE(task->action == kept_step ? lost_of_sum(y, s, sum) : t, d.arena + task->out + low + at);
  return sum;
}

static inline REAL leapfrog_update(device d, global const row_stage* task, const long place,
                                   element e, vec force, REAL inverse_mass, spin angular,
                                   REAL turn_scale, const int is_predicted, REAL check) {
  global NUMBER* p = d.arena + task->out + place;
  global const NUMBER* halves = d.arena + task->base + place + FIELDS * W;
  vec v_half = e.v;
  spin w_half = e.w;
  if (is_predicted) v_half = vec_at(halves), w_half = spin_at(halves + VEC_SIZE * W);
  const leap next =
      leapfrog(e, v_half, w_half, vec_scale(inverse_mass, force), spin_scale(turn_scale, angular),
               SPLAT(task->beta), SPLAT(task->alpha[0]), SPLAT(task->alpha[1] * task->beta));
  put_vec(next.u, p);
  put_vec(is_predicted ? next.v_next : next.v_half, p + VEC_SIZE * W);
  put_rotor(next.q, p + 2 * VEC_SIZE * W);
  put_spin(is_predicted ? next.w_next : next.w_half, p + (FIELDS - SPIN_SIZE) * W);
  if (is_predicted)
    put_vec(next.v_half, p + FIELDS * W), put_spin(next.w_half, p + (FIELDS + VEC_SIZE) * W);
  return finite_check(next.v_half, next.w_half, FMA(rotor_sign_of_life(next.q), SPLAT(0), check));
}

/* y becomes y + (low + change). Then `low` moves on to the next component. */
#define SUM_UP(c)                                              \
  {                                                            \
    const REAL s = LOAD(low) + c, y = LOAD(from), sum = y + s; \
    STORE(lost_of_sum(y, s, sum), low_out);                    \
    c = sum, from += W, low += W, low_out += W;                \
  }
static inline REAL kept_leapfrog_update(device d, global const row_stage* task, const long place,
                                        element e, vec force, REAL inverse_mass, spin angular,
                                        REAL turn_scale, const int is_predicted, REAL check) {
  const REAL h = SPLAT(task->beta), smoothing = SPLAT(task->alpha[0]),
             ahead = SPLAT(task->alpha[1] * task->beta);
  global const NUMBER* const in = d.arena + task->base + place;
  global NUMBER* const out = d.arena + task->out + place;
  const int v_at = VEC_SIZE * W, q_at = 2 * VEC_SIZE * W, w_at = (FIELDS - SPIN_SIZE) * W;
  const vec a = vec_scale(inverse_mass, force);
  const spin alpha = spin_scale(turn_scale, angular);
  vec v = vec_scale(h, a), v_half = e.v;
  spin w = spin_scale(h, alpha), w_half = e.w;
  if (is_predicted)
    v_half = vec_at(in + FIELDS * W), w_half = spin_at(in + (FIELDS + VEC_SIZE) * W);
  global const NUMBER *from = is_predicted ? in + FIELDS * W : in + v_at,
                      *low = in + task->low + v_at;
  global NUMBER* low_out = out + task->low + v_at;
  EACH_OF_VEC(SUM_UP, v)
  from = is_predicted ? in + (FIELDS + VEC_SIZE) * W : in + w_at, low = in + task->low + w_at;
  low_out = out + task->low + w_at;
  EACH_OF_SPIN(SUM_UP, w)
  vec u = vec_scale(h, v);
  from = in, low = in + task->low, low_out = out + task->low;
  EACH_OF_VEC(SUM_UP, u)
  rotor q = rotor_cayley_change(e.q, spin_scale(SPLAT(0.25) * h, w));
  from = in + q_at, low = in + task->low + q_at, low_out = out + task->low + q_at;
  EACH_OF_ROTOR(SUM_UP, q)
  put_vec(u, out);
  put_vec(is_predicted ? vec_predicted(e.v, v_half, v, a, smoothing, ahead) : v, out + v_at);
  put_rotor(q, out + q_at);
  put_spin(is_predicted ? spin_predicted(e.w, w_half, w, alpha, smoothing, ahead) : w, out + w_at);
  if (is_predicted) put_vec(v, out + FIELDS * W), put_spin(w, out + (FIELDS + VEC_SIZE) * W);
  return finite_check(v, w, FMA(rotor_sign_of_life(q), SPLAT(0), check));
}

static inline REAL runge_kutta_update(device d, global const row_stage* task, const long place,
                                      element e, vec force, REAL inverse_mass, spin angular,
                                      REAL turn_scale, REAL check) {
  const int action = task->action;
  global NUMBER* p = d.arena + task->out + place;
  global const NUMBER* y = d.arena + task->base + place;
  const NUMBER h = task->beta * d.step;
  vec next_u = e.v, next_v = force;
  rotor next_q = rotor_spun(e.q, e.w);
  spin next_w = angular;
  if (HAS(combined_stage) && action == combined_stage) {
    global const NUMBER *y1 = d.arena + task->increment[0] + place,
                        *y2 = d.arena + task->increment[1] + place,
                        *y3 = d.arena + task->increment[2] + place;
    const REAL a1 = SPLAT(task->alpha[0]), a2 = SPLAT(task->alpha[1]), a3 = SPLAT(task->alpha[2]);
#define COMBINE(c)                                                                                \
  c = rk_combined(LOAD(y), beta, c, LOAD(y1), LOAD(y2), LOAD(y3), a1, a2, a3), STORE_EARLY(c, p), \
  p += W, y += W, y1 += W, y2 += W, y3 += W;
    EACH_NEXT(COMBINE)
  } else if (HAS(wide_stage) && action == wide_stage) {
    long at = place;
#define COMBINE_ALL(c) \
  c = wide_sum(d, task, at, LOAD(y), beta, c), STORE_EARLY(c, p), p += W, y += W, at += W;
    EACH_NEXT(COMBINE_ALL)
  } else if ((HAS(kept_stage) && action == kept_stage) || (HAS(kept_step) && action == kept_step)) {
    long at = place;
#define KEEP_SUM(c) c = kept_sum(d, task, at, beta, c), STORE_EARLY(c, p), p += W, at += W;
    EACH_NEXT(KEEP_SUM)
  } else if (HAS(error_stage) && action == error_stage) {
    long at = place;
#define ESTIMATE(c) \
  c = estimate(d, task, at, LOAD(y), beta, c), STORE_EARLY(c, p), p += W, y += W, at += W;
    EACH_NEXT(ESTIMATE)
  } else if (HAS(kept_error) && action == kept_error) {
    long at = place;
#define KEPT_ESTIMATE(c) \
  c = kept_increment(d, task, at, beta, c), STORE_EARLY(c, p), p += W, at += W;
    EACH_NEXT(KEPT_ESTIMATE)
  } else {
#define ADVANCE(c) c = rk_first(LOAD(y), beta, c), STORE_EARLY(c, p), p += W, y += W;
    EACH_NEXT(ADVANCE)
  }
  p = d.arena + task->out + place;
#define LATE(c) STORE_LATE(c, p), p += W;
  EACH_OF_VEC(LATE, next_u)
  EACH_OF_VEC(LATE, next_v)
  EACH_OF_ROTOR(LATE, next_q)
  EACH_OF_SPIN(LATE, next_w)
  return task->is_last ? finite_check(next_v, next_w, check) : check;
}

static inline REAL row_update(device d, global const row_stage* task, const long place, element e,
                              vec force, REAL inverse_mass, spin angular, REAL turn_scale,
                              REAL check) {
  const int action = task->action;
  global NUMBER* p = d.arena + task->out + place;
  if (HAS(bare_rates) && action == bare_rates) {
    put_vec(e.v, p);
    put_vec(force, p + VEC_SIZE * W);
    put_rotor(rotor_spun(e.q, e.w), p + 2 * VEC_SIZE * W);
    put_spin(angular, p + (FIELDS - SPIN_SIZE) * W);
    return check;
  }
  if ((HAS(leapfrog_step) && action == leapfrog_step) ||
      (HAS(predicted_step) && action == predicted_step))
    return leapfrog_update(d, task, place, e, force, inverse_mass, angular, turn_scale,
                           action == predicted_step, check);
  if ((HAS(kept_leapfrog) && action == kept_leapfrog) ||
      (HAS(kept_predicted) && action == kept_predicted))
    return kept_leapfrog_update(d, task, place, e, force, inverse_mass, angular, turn_scale,
                                action == kept_predicted, check);
  return runge_kutta_update(d, task, place, e, force, inverse_mass, angular, turn_scale, check);
}
