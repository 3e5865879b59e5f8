#pragma once
/// What a stage does with the force and the turn of a pack (kernels/motion/motion.h): the two families of methods. Passed to
/// StageRow::run; turn_scale: w' over turn.
#include "kernels/physics.hpp"
#include "kernels/stage_row/row.hpp"

DSS_INLINE_BEGIN
namespace dss {

/// Notices lanes that stop being finite at one multiply-add a component: 0 * x is 0 unless x is infinite or NaN.
template <class R, class T>
struct FiniteCheck {
  R sum = R(T(0));
  template <class Tuple>
  void add(Tuple t) {
    each_component(t, [&](R& c) { sum = simd::fma(c, R(T(0)), sum); });
  }
  bool passed() const { return simd::is_zero(sum); }
};

/// out = base + sum alpha_m (increment_m - base) + beta f(in), as rk_update.h computes it, with three increments or none (a task with
/// fewer repeats one with the ratio 0). Only a last stage, which has increments in every method, looks for non-finite velocities.
template <class P, class T, bool has_increments>
struct RungeKuttaUpdate {
  using R = typename P::real;
  static constexpr int W = simd::lanes<T>;
  const T *const base, *const increment[3];
  T* const out;
  const R alpha[3], beta_u, beta_v, beta_q, beta_w;
  FiniteCheck<R, T> check{};

  explicit RungeKuttaUpdate(const RowTask<T>& task, T turn_scale)
      : base(task.base), increment{task.increment[0], task.increment[1], task.increment[2]},
        out(task.out), alpha{R(task.alpha[0]), R(task.alpha[1]), R(task.alpha[2])}, beta_u(task.beta),
        beta_v(task.beta * task.body->inverse_mass), beta_q(task.beta * T(0.5)), beta_w(task.beta * turn_scale) {}

  /// Rates in, the next stage's fields out.
  template <class Tuple>
  Tuple store_next(std::ptrdiff_t& at, R beta, Tuple rates) {
    each_component(rates, [&](R& k) {
      const R y = simd::load(base + at);
      if constexpr (has_increments) {
        k = P::rk_combined(y, beta, k, simd::load(increment[0] + at), simd::load(increment[1] + at),
                           simd::load(increment[2] + at), alpha[0], alpha[1], alpha[2]);
      } else {
        k = P::rk_first(y, beta, k);
      }
      simd::store(out + at, k);
      at += W;
    });
    return rates;
  }
  void operator()(std::ptrdiff_t at, const typename P::element& e, const typename P::vec& force,
                  const typename P::spin& turn) {
    store_next(at, beta_u, e.v);
    const auto v = store_next(at, beta_v, force);
    store_next(at, beta_q, P::rotor_spun(e.q, e.w));
    const auto w = store_next(at, beta_w, turn);
    if constexpr (has_increments) check.add(v), check.add(w);
  }
};

/// One leapfrog step in place. With velocity-dependent forces the fields v and w of a row hold the prediction p that
/// the links see, and the half-step velocities follow the 13 (7) fields of the pack; without them v and w are the
/// half-step velocities themselves.
template <class P, class T, bool is_predicted>
struct LeapfrogUpdate {
  using R = typename P::real;
  static constexpr int W = simd::lanes<T>;
  const T* const half_velocities;
  T* const out;
  const R h, inverse_mass, turn_scale;
  FiniteCheck<R, T> check{};

  explicit LeapfrogUpdate(const RowTask<T>& task, T scale_of_turn)
      : half_velocities(task.base + P::fields * W), out(task.out), h(task.beta), inverse_mass(task.body->inverse_mass),
        turn_scale(scale_of_turn) {}

  template <class Tuple>
  static void store_all(T*& p, Tuple t) {
    each_component(t, [&](R& c) { simd::store(p, c), p += W; });
  }
  void operator()(std::ptrdiff_t place, const typename P::element& e, const typename P::vec& force,
                  const typename P::spin& turn) {
    T* p = out + place;
    auto v_half = e.v;
    auto w_half = e.w;
    if constexpr (is_predicted) {
      const T* half = half_velocities + place;
      const auto load = [&](R& c) { c = simd::load(half), half += W; };
      each_component(v_half, load);
      each_component(w_half, load);
    }
    const auto next =
        P::leapfrog(e.u, e.q, v_half, w_half, P::vec_scale(inverse_mass, force), P::spin_scale(turn_scale, turn), h);
    store_all(p, next.u);
    store_all(p, is_predicted ? next.v_next : next.v_half);
    store_all(p, next.q);
    store_all(p, is_predicted ? next.w_next : next.w_half);
    if constexpr (is_predicted) {
      store_all(p, next.v_half);
      store_all(p, next.w_half);
    }
    check.add(next.v_half);
    check.add(next.w_half);
  }
};

} // namespace dss
DSS_INLINE_END
