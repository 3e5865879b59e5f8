#pragma once
/// Updates the packs of a row, one after the other, by the action of its task (row_update.h).
#include "kernels/physics.hpp"

namespace dss {

/// Factors of a row's update.
template <class R>
struct UpdateScales {
  R beta;         ///< from a rate to its increment [s]
  R inverse_mass; ///< [1 / unit of mass of BodyConstants]
  R turn_scale;   ///< w' divided by turn (kernels/motion/motion.h)
};

/// Updates one pack by an action of apart_action. Returns 0, or NaN if a result is not finite.
template <class P, class T, int W>
[[gnu::noinline]] DSS_FLATTEN typename P::real
update_apart(const RowTask<T>& task, UpdateScales<typename P::real> scales, std::ptrdiff_t at,
             const typename P::element& e, const typename P::vec& force,
             const typename P::spin& turn);
DSS_INLINE_BEGIN

/// @tparam W  numbers from a component of a pack to the next
/// @tparam fixed_action  the one action of all tasks, which saves a branch a pack; or a set of
///     actions (ActionSet), and the task selects one of them
template <class P, class T, int W = simd::lanes<T>, int fixed_action = any_action>
class RowUpdate {
public:
  using R = typename P::real;
  using vec = typename P::vec;
  using spin = typename P::spin;
  using element = typename P::element;

  RowUpdate(const RowTask<T>& task, UpdateScales<R> scales)
      : constants_(
            Update::update_of_row(&task, scales.beta, scales.inverse_mass, scales.turn_scale)) {}

  /// @param at  offset of the pack in its row
  void operator()(std::ptrdiff_t at, const element& e, const vec& force, const spin& turn) {
    if constexpr (fixed_action == any_action || fixed_action == rest_called)
      if (fixed_action == rest_called || is_rare(constants_.row->action)) {
        check_ = check_ + act_apart(at, e, force, turn);
        return;
      }
    check_ = Update::updated(constants_, at, e, force, turn, check_);
  }
  /// 0, or NaN if a result that must be finite is not.
  R check() const { return check_; }
  bool is_finite() const { return simd::is_zero(check_); }

private:
  using Update = typename P::template Update<T, W, fixed_action>;

  /// Passed by value: taking an address would force the operands into memory for common actions
  /// too.
  R act_apart(std::ptrdiff_t at, element e, vec force, spin turn) const {
    return update_apart<P, T, W>(
        *constants_.row, {constants_.beta_u, constants_.inverse_mass, constants_.turn_scale}, at, e,
        force, turn);
  }

  const typename Update::row_update constants_;
  R check_ = R(T(0));
};

DSS_INLINE_END
template <class P, class T, int W>
typename P::real update_apart(const RowTask<T>& task, UpdateScales<typename P::real> scales,
                              std::ptrdiff_t at, const typename P::element& e,
                              const typename P::vec& force, const typename P::spin& turn) {
  RowUpdate<P, T, W, apart_action> update(task, scales);
  update(at, e, force, turn);
  return update.check();
}

} // namespace dss
