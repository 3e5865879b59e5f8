#pragma once
/// How the stages of a method update the state, in the form that row tasks take.
#include "variants/engine/row_storage.hpp"

#include <utility>

namespace dss {

/// Signals of some stages as the kernels take them: one row for each stage, in numbers of type T,
/// followed by a constant 1.
template <class T>
class StepSignals {
public:
  StepSignals(std::size_t count, int stages)
      : count_(count), values_(std::size_t(stages) * (count + 1), T(1)) {}
  void set(const double* rows, int stages) {
    for (std::size_t s = 0; s < std::size_t(stages); ++s)
      for (std::size_t n = 0; n < count_; ++n)
        values_[s * (count_ + 1) + n] = T(rows[s * count_ + n]);
  }
  const T* stage(int s) const { return values_.data() + std::size_t(s) * (count_ + 1); }

private:
  std::size_t count_;
  std::vector<T> values_;
};

/// How a stage updates the state: out = y + beta f + sum of alpha (Y_m - y). Later alphas are
/// ratios to the first (kernels/stage_row/row.hpp).
template <class T>
struct StageUpdate {
  row_action action = plain_stage;
  bool is_last = false;
  int low = 0; ///< as RowTask::low
  T beta = 0;
  /// Pairs of the stage m whose output is Y_m, and of alpha or its ratio.
  std::vector<std::pair<int, T>> increments;
  T smoothing = 0, steps_ahead = 0; ///< of a leapfrog's prediction, see RowTask
  /// Sets what this update determines of a task.
  /// @param base, out     rows of the present state and of the result
  /// @param stage_output  function from m to the row of the output of stage m
  /// @param step          length of the step, if the method has an error stage [s]
  template <class StageOutput>
  void set(RowTask<T>& task, T* base, T* out, StageOutput&& stage_output, T step = 1) const {
    task.action = action;
    task.is_last = is_last;
    task.low = low;
    task.base = base;
    task.out = out;
    task.beta = step * beta;
    task.increments = int(increments.size());
    task.alpha[0] = smoothing, task.alpha[1] = steps_ahead;
    for (std::size_t m = 0; !increments.empty() && m < std::size(task.alpha); ++m) {
      const bool is_used = m < increments.size();
      task.increment[m] = stage_output(increments[is_used ? m : 0].first);
      task.alpha[m] = is_used ? increments[m].second : T(0);
    }
  }
};
/// The update of each stage of the method. With a method with an error stage, these have a step of
/// 1, and set() gets the length of each step.
/// @param lanes  lanes of a pack
/// @param dt     step [s]
/// @throws std::logic_error if a stage has more increments than a task holds
template <class T>
std::vector<StageUpdate<T>> stage_updates(const Method& method, const RowStorage& storage,
                                          int lanes, double dt);
} // namespace dss
