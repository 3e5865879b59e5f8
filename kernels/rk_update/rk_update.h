/* State updates (shared subset). solver/numerics/method.hpp lists the methods. */

/* Runge-Kutta stage in increment form: y + sum_m alpha_m (Y_m - y) + beta f = y + alpha_1 t with
 *   t = (beta / alpha_1) f + (Y_1 - y) + sum_{m > 1} (alpha_m / alpha_1) (Y_m - y)
 * Increments are summed before y is added. So y is rounded once, and a state at rest stays at rest
 * to the last bit. */
static inline REAL rk_increment(REAL ratio, REAL stage, REAL y, REAL t) {
  return FMA(ratio, stage - y, t);
}
static inline REAL rk_finish(REAL alpha_1, REAL t, REAL y) { return FMA(alpha_1, t, y); }
/* y + beta f. The first term of t is the same operation on Y_1 - y. */
static inline REAL rk_first(REAL y, REAL beta, REAL rate) { return FMA(beta, rate, y); }
/* Estimate of a step's error: a sum of increments, without y. */
static inline REAL rk_estimate(REAL alpha_1, REAL t) { return alpha_1 * t; }
/* Stage with three increments. y1, y2, y3 are the Y_m; ratio_m = alpha_m / alpha_1. */
static inline REAL rk_combined(REAL y, REAL beta, REAL rate, REAL y1, REAL y2, REAL y3,
                               REAL alpha_1, REAL ratio_2, REAL ratio_3) {
  REAL t = rk_first(y1 - y, beta, rate);
  t = rk_increment(ratio_2, y2, y, t);
  t = rk_increment(ratio_3, y3, y, t);
  return rk_finish(alpha_1, t, y);
}

/* Leapfrog step:
 *   v_{n+1/2} = v_{n-1/2} + h a
 *   x_{n+1}   = x_n + h v_{n+1/2}
 *   p_{n+1}   = v_{n+1/2} + smoothing (p_n - v_{n-1/2}) + ahead a
 * p is the predicted velocity that forces see. v and w of `e` are p_n; v_half and w_half are those
 * at n - 1/2. */
typedef struct {
  vec u, v_half, v_next;
  rotor q;
  spin w_half, w_next;
} leap;
static inline vec vec_predicted(vec seen, vec before, vec after, vec a, REAL smoothing,
                                REAL ahead) {
  return vec_axpy(ahead, a, vec_axpy(smoothing, vec_sub(seen, before), after));
}
static inline spin spin_predicted(spin seen, spin before, spin after, spin a, REAL smoothing,
                                  REAL ahead) {
  return spin_axpy(ahead, a, spin_axpy(smoothing, spin_sub(seen, before), after));
}
static inline leap leapfrog(element e, vec v_half, spin w_half, vec a, spin alpha, REAL h,
                            REAL smoothing, REAL ahead) {
  leap r;
  r.v_half = vec_axpy(h, a, v_half);
  r.w_half = spin_axpy(h, alpha, w_half);
  r.u = vec_axpy(h, r.v_half, e.u);
  r.q = rotor_cayley(e.q, spin_scale(SPLAT(0.25) * h, r.w_half));
  r.v_next = vec_predicted(e.v, v_half, r.v_half, a, smoothing, ahead);
  r.w_next = spin_predicted(e.w, w_half, r.w_half, alpha, smoothing, ahead);
  return r;
}

/* Compensated sums (f32c). The pair (y, low) stands for y + low; |low| is at most half a unit in
 * the last place of y. An increment D_m = Y_m - y is stored as computed, never as a difference of
 * rounded states:
 *   D = beta f + sum_m alpha_m D_m,   Y = y + (low + D)
 * D of the whole step makes the next y and low. kept_first and kept_later compute, term by term,
 *   t = (beta / alpha_1) f + D_1 + sum_{m > 1} (alpha_m / alpha_1) D_m,   D = alpha_1 t */
static inline REAL kept_first(REAL d, REAL beta, REAL rate) { return FMA(beta, rate, d); }
static inline REAL kept_later(REAL ratio, REAL d, REAL t) { return FMA(ratio, d, t); }
/* Rounding error of sum = y + s, exactly (Knuth, The Art of Computer Programming 2, section 4.2.2,
 * theorem B). */
static inline REAL lost_of_sum(REAL y, REAL s, REAL sum) {
  REAL t = sum - y;
  return (y - (sum - t)) + (s - t);
}
