#pragma once
/// What each action does with the force and the turn of a pack (kernels/motion/motion.h), for every
/// family of methods. StageRow::run calls it for each pack. turn_scale is w' divided by turn.
#include "kernels/physics.hpp"
#include "kernels/stage_row/row.hpp"

#include <limits>

DSS_INLINE_BEGIN
namespace dss {

/// Detects lanes that become infinite or NaN, at one multiply-add a component: 0 * x is 0 unless x
/// is infinite or NaN.
template <class R, class T>
struct FiniteCheck {
  R sum = R(T(0));
  template <class Tuple>
  void add(Tuple t) {
    each_component(t, [&](R& c) { sum = simd::fma(c, R(T(0)), sum); });
  }
  void add_one(R c) { sum = simd::fma(c, R(T(0)), sum); }
  bool passed() const { return simd::is_zero(sum); }
};

/// Values of fixed_action besides a single action. The rare actions would be most of a row's code
/// and of its compile time if they were inlined. Common rows (many runs use them) have one function
/// for each common action and one function with the rest inlined (rare_action). Other rows call one
/// noinline function for the rare actions (apart_action), shared by all terms.
inline constexpr int any_action = -1;   ///< all: common actions inlined, rare ones called
inline constexpr int rare_action = -2;  ///< all without a function of their own in common rows
inline constexpr int apart_action = -3; ///< only the rare ones
/// True for actions that few runs use.
constexpr bool is_rare(row_action action) {
  return action != plain_stage && action != combined_stage && action != leapfrog_step &&
         action != predicted_step;
}

DSS_INLINE_END
/// Updates one pack by a rare action. Returns 0, or NaN if a velocity is not finite.
template <class P, class T, int W>
[[gnu::noinline]] typename P::real update_apart(const RowTask<T>& task, T scale_of_turn,
                                                std::ptrdiff_t at, const typename P::element& e,
                                                const typename P::vec& force,
                                                const typename P::spin& turn);
DSS_INLINE_BEGIN

/// Applies the action of a task to one pack after the other (formulas: rk_update.h).
/// @tparam W  numbers from a component of a pack to the next
/// @tparam fixed_action  the one action of all tasks, which saves a branch a pack; or a set of
///     actions (any_action, ...), and the task selects one of them
template <class P, class T, int W = simd::lanes<T>, int fixed_action = any_action>
class RowUpdate {
public:
  using R = typename P::real;
  using vec = typename P::vec;
  using spin = typename P::spin;
  using rotor = typename P::rotor;
  using element = typename P::element;

  explicit RowUpdate(const RowTask<T>& task, T scale_of_turn)
      : task_(task), action_(is_fixed ? row_action(fixed_action) : task.action),
        is_last_(task.is_last),
        base_(task.base), increment_{task.increment[0], task.increment[1], task.increment[2]},
        out_(task.out),
        low_(task.low), alpha_{R(task.alpha[0]), R(task.alpha[1]), R(task.alpha[2])},
        beta_u_(task.beta), beta_v_(task.beta * task.body->inverse_mass),
        beta_q_(task.beta * T(0.5)), beta_w_(task.beta * scale_of_turn), smoothing_(task.alpha[0]),
        ahead_(task.alpha[1] * task.beta), inverse_mass_(task.body->inverse_mass),
        turn_scale_(scale_of_turn) {}

  void operator()(std::ptrdiff_t at, const element& e, const vec& force, const spin& turn) {
    if constexpr (fixed_action == any_action)
      if (is_rare(action_)) {
        check.add_one(act_apart(at, e, force, turn));
        return;
      }
    act(at, e, force, turn);
  }
  FiniteCheck<R, T> check{};

private:
  static constexpr bool is_fixed = fixed_action >= 0;
  static constexpr bool is_compensated =
      sizeof(T) <= sizeof(float); ///< double precision needs no low parts
  static constexpr bool has(row_action action) {
    if (is_fixed) return action == fixed_action;
    if (fixed_action == any_action) return !is_rare(action);
    if (fixed_action == apart_action) return is_rare(action);
    return action != plain_stage && action != combined_stage && action != kept_stage &&
           action != kept_step;
  }

  /// Passed by value: taking an address would force the operands into memory for common actions
  /// too.
  R act_apart(std::ptrdiff_t at, element e, vec force, spin turn) const {
    return update_apart<P, T, W>(task_, turn_scale_, at, e, force, turn);
  }
  void act(std::ptrdiff_t at, const element& e, const vec& force, const spin& turn) {
    switch (is_fixed ? row_action(fixed_action) : action_) {
    case plain_stage:
      if constexpr (has(plain_stage))
        return runge_kutta(at, e, force, turn, [&](std::ptrdiff_t n, R beta, R rate) {
          return P::rk_first(load(base_ + n), beta, rate);
        });
      break;
    case combined_stage:
      if constexpr (has(combined_stage))
        return runge_kutta(at, e, force, turn, [&](std::ptrdiff_t n, R beta, R rate) {
          return P::rk_combined(load(base_ + n), beta, rate, load(increment_[0] + n),
                                load(increment_[1] + n), load(increment_[2] + n), alpha_[0],
                                alpha_[1], alpha_[2]);
        });
      break;
    case wide_stage:
      if constexpr (has(wide_stage))
        return runge_kutta(at, e, force, turn,
                           [&](std::ptrdiff_t n, R beta, R rate) { return wide(n, beta, rate); });
      break;
    case error_stage:
      if constexpr (has(error_stage))
        return runge_kutta(at, e, force, turn, [&](std::ptrdiff_t n, R beta, R rate) {
          return P::rk_estimate(alpha_[0], increments(n, load(base_ + n), beta, rate));
        });
      break;
    case kept_error:
      if constexpr (has(kept_error) && is_compensated)
        return runge_kutta(at, e, force, turn, [&](std::ptrdiff_t n, R beta, R rate) {
          return kept_wide(n, beta, rate);
        });
      break;
    case leapfrog_step:
      if constexpr (has(leapfrog_step)) return leapfrog(at, e, e.v, e.w, force, turn, false);
      break;
    case predicted_step:
      if constexpr (has(predicted_step)) {
        auto [v_half, w_half] = half_velocities(at);
        return leapfrog(at, e, v_half, w_half, force, turn, true);
      }
      break;
    case kept_stage:
      if constexpr (has(kept_stage) && is_compensated)
        return kept_runge_kutta<false>(at, e, force, turn);
      break;
    case kept_step:
      if constexpr (has(kept_step) && is_compensated)
        return kept_runge_kutta<true>(at, e, force, turn);
      break;
    case kept_leapfrog:
    case kept_predicted:
      if constexpr ((has(kept_leapfrog) || has(kept_predicted)) && is_compensated)
        return kept_in_place(at, e, force, turn);
      break;
    default:
      break;
    }
    check.add_one(R(std::numeric_limits<T>::quiet_NaN())); // an action that is not compiled
  }
  static R load(const T* p) { return simd::load(p); }
  template <class Tuple>
  static Tuple load_all(const T*& p) {
    Tuple t{};
    each_component(t, [&](R& c) { c = load(p), p += W; });
    return t;
  }
  template <class Tuple>
  static void store_all(T*& p, Tuple t) {
    each_component(t, [&](R& c) { simd::store(p, c), p += W; });
  }

  /// next(place, beta, rate) returns the new value of a component.
  template <class Next>
  void runge_kutta(std::ptrdiff_t at, const element& e, const vec& force, const spin& turn,
                   Next&& next) {
    const auto each = [&](R beta, auto rates) {
      each_component(rates, [&](R& k) {
        k = next(at, beta, k);
        simd::store(out_ + at, k);
        at += W;
      });
      return rates;
    };
    each(beta_u_, e.v);
    const vec v = each(beta_v_, force);
    each(beta_q_, P::rotor_spun(e.q, e.w));
    const spin w = each(beta_w_, turn);
    if (is_last_) check.add(v), check.add(w);
  }

  R wide(std::ptrdiff_t at, R beta, R rate) const {
    const R y = load(base_ + at);
    return P::rk_finish(alpha_[0], increments(at, y, beta, rate), y);
  }
  R increments(std::ptrdiff_t at, R y, R beta, R rate) const {
    R t = P::rk_first(load(task_.increment[0] + at) - y, beta, rate);
    for (int m = 1; m < task_.increments; ++m)
      t = P::rk_increment(R(task_.alpha[m]), load(task_.increment[m] + at), y, t);
    return t;
  }

  /// Stores the increment behind the field. The last stage stores the state's low part there
  /// instead.
  template <bool is_step>
  void kept_runge_kutta(std::ptrdiff_t at, const element& e, const vec& force, const spin& turn) {
    const auto with = [&](auto&& increment) {
      runge_kutta(at, e, force, turn, [&](std::ptrdiff_t n, R beta, R rate) {
        const R d = increment(n, beta, rate), y = load(base_ + n), s = load(base_ + low_ + n) + d,
                sum = y + s;
        simd::store(out_ + low_ + n, is_step ? P::lost_of_sum(y, s, sum) : d);
        return sum;
      });
    };
    const int count = task_.increments;
    if (count == 0) return with([](std::ptrdiff_t, R beta, R rate) { return beta * rate; });
    if (count <= 3)
      return with([&](std::ptrdiff_t n, R beta, R rate) {
        R t = P::kept_first(load(increment_[0] + low_ + n), beta, rate);
        t = P::kept_later(alpha_[1], load(increment_[1] + low_ + n), t);
        return alpha_[0] * P::kept_later(alpha_[2], load(increment_[2] + low_ + n), t);
      });
    with([&](std::ptrdiff_t n, R beta, R rate) { return kept_wide(n, beta, rate); });
  }
  R kept_wide(std::ptrdiff_t at, R beta, R rate) const {
    R t = P::kept_first(load(increment_[0] + low_ + at), beta, rate);
    for (int m = 1; m < task_.increments; ++m)
      t = P::kept_later(R(task_.alpha[m]), load(task_.increment[m] + low_ + at), t);
    return alpha_[0] * t;
  }

  struct Velocities {
    vec v;
    spin w;
  };
  Velocities half_velocities(std::ptrdiff_t at) const {
    const T* p = base_ + at + P::fields * W;
    Velocities half;
    half.v = load_all<vec>(p);
    half.w = load_all<spin>(p);
    return half;
  }

  /// One step in place. If forces depend on velocities, the fields v and w of a row hold the
  /// prediction p that the links see, and the half-step velocities follow the pack's fields.
  /// Otherwise v and w are the half-step velocities.
  void leapfrog(std::ptrdiff_t at, const element& e, const vec& v_half, const spin& w_half,
                const vec& force, const spin& turn, bool is_predicted) {
    T* p = out_ + at;
    const auto next = P::leapfrog(e, v_half, w_half, P::vec_scale(inverse_mass_, force),
                                  P::spin_scale(R(turn_scale_), turn), beta_u_, smoothing_, ahead_);
    store_all(p, next.u);
    store_all(p, is_predicted ? next.v_next : next.v_half);
    store_all(p, next.q);
    store_all(p, is_predicted ? next.w_next : next.w_half);
    if (is_predicted) {
      store_all(p, next.v_half);
      store_all(p, next.w_half);
    }
    check.add(next.v_half);
    check.add(next.w_half);
    // The Cayley map squares its argument, so q may overflow before w does.
    check.add_one(P::rotor_sign_of_life(next.q));
  }

  /// Sums y + (low + d) and their low parts, component by component.
  template <class Tuple>
  struct Sum {
    Tuple value, low;
    Sum(const Tuple& y, const Tuple& y_low, const Tuple& d) {
      const Tuple s = each_pair(y_low, d, [](const R& a, const R& b) { return a + b; });
      value = each_pair(y, s, [](const R& a, const R& b) { return a + b; });
      low = each_pair(y, s, [](const R& a, const R& b) { return P::lost_of_sum(a, b, a + b); });
    }
  };
  /// Leapfrog step with compensated sums. The low parts of u, v, q and w follow all other numbers
  /// of the pack, in the order of the fields.
  void kept_in_place(std::ptrdiff_t at, const element& e, const vec& force, const spin& turn) {
    const bool is_predicted = action_ == kept_predicted;
    const Velocities half = is_predicted ? half_velocities(at) : Velocities{e.v, e.w};
    const T* from = base_ + low_ + at;
    const vec u_low = load_all<vec>(from), v_low = load_all<vec>(from);
    const rotor q_low = load_all<rotor>(from);
    const spin w_low = load_all<spin>(from);
    const R h = beta_u_;
    const vec a = P::vec_scale(inverse_mass_, force);
    const spin alpha = P::spin_scale(R(turn_scale_), turn);
    const Sum<vec> v(half.v, v_low, P::vec_scale(h, a));
    const Sum<spin> w(half.w, w_low, P::spin_scale(h, alpha));
    const Sum<vec> u(e.u, u_low, P::vec_scale(h, v.value));
    const Sum<rotor> q(e.q, q_low,
                       P::rotor_cayley_change(e.q, P::spin_scale(R(T(0.25)) * h, w.value)));
    T* p = out_ + at;
    store_all(p, u.value);
    store_all(p, is_predicted ? P::vec_predicted(e.v, half.v, v.value, a, smoothing_, ahead_)
                              : v.value);
    store_all(p, q.value);
    store_all(p, is_predicted ? P::spin_predicted(e.w, half.w, w.value, alpha, smoothing_, ahead_)
                              : w.value);
    if (is_predicted) {
      store_all(p, v.value);
      store_all(p, w.value);
    }
    T* low = out_ + low_ + at;
    store_all(low, u.low);
    store_all(low, v.low);
    store_all(low, q.low);
    store_all(low, w.low);
    check.add(v.value);
    check.add(w.value);
    check.add_one(P::rotor_sign_of_life(q.value));
  }

  const RowTask<T>& task_;
  const row_action action_;
  const bool is_last_;
  const T *const base_, *const increment_[3];
  T* const out_;
  const std::ptrdiff_t low_;
  const R alpha_[3], beta_u_, beta_v_, beta_q_, beta_w_;
  const R smoothing_, ahead_; ///< constants of the leapfrog prediction
  const R inverse_mass_;
  const T turn_scale_;
};

DSS_INLINE_END
template <class P, class T, int W>
typename P::real update_apart(const RowTask<T>& task, T scale_of_turn, std::ptrdiff_t at,
                              const typename P::element& e, const typename P::vec& force,
                              const typename P::spin& turn) {
  RowUpdate<P, T, W, apart_action> update(task, scale_of_turn);
  update(at, e, force, turn);
  return update.check.sum;
}

} // namespace dss
