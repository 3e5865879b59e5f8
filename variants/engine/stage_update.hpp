#pragma once
/// How the stages of a method update the state, in the form that row tasks take.
#include "variants/engine/row_storage.hpp"

#include <span>
#include <utility>

namespace dss {

/// Signals of some stages as the kernels take them: one row for each stage, in numbers of type T,
/// followed by a constant 1. Of an ensemble each is a pack, of all members.
template <class T>
class StepSignals {
public:
  /// @param count    signals of a problem
  /// @param members  of the ensemble; 1: a problem alone
  StepSignals(std::size_t count, int stages, std::size_t members = 1)
      : count_(count * members), width_(count_ + members), values_(std::size_t(stages) * width_) {
    for (T& value : std::span(values_.data(), values_.size())) value = 1;
  }
  void set(const double* rows, int stages) {
    for (std::size_t s = 0; s < std::size_t(stages); ++s)
      for (std::size_t n = 0; n < count_; ++n)
        values_.data()[s * width_ + n] = T(rows[s * count_ + n]);
  }
  const T* stage(int s) const { return values_.data() + std::size_t(s) * width_; }

private:
  std::size_t count_, width_;
  Buffer<T> values_; ///< aligned for packs
};

/// How a stage updates the state: out = y + beta f + sum of alpha (Y_m - y). Later alphas are
/// ratios to the first (kernels/stage_row/row.hpp).
template <class T>
struct StageUpdate {
  row_action action = plain_stage;
  bool is_last = false;
  int low = 0; ///< as RowTask::low
  T beta = 0;
  Buffer<T> betas; ///< of an ensemble, as RowTask::betas
  /// Pairs of the stage m whose output is Y_m, and of alpha or its ratio.
  std::vector<std::pair<int, T>> increments;
  T smoothing = 0, steps_ahead = 0; ///< of a leapfrog's prediction, see RowTask
  /// Sets what this update determines of a task.
  /// @param base, out     rows of the present state and of the result
  /// @param stage_output  function from m to the row of the output of stage m
  /// @param step          length of the step, if the method has an error stage [s]
  /// The task of an ensemble must not outlive this update.
  template <class StageOutput>
  void set(RowTask<T>& task, T* base, T* out, StageOutput&& stage_output, T step = 1) const {
    task.action = action;
    task.is_last = is_last;
    task.low = low;
    task.base = base;
    task.out = out;
    task.beta = step * beta;
    task.betas = betas.data();
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
/// @param dt     step [s]; of an ensemble: of each member
/// @throws std::logic_error if a stage has more increments than a task holds
template <class T>
std::vector<StageUpdate<T>> stage_updates(const Method& method, const RowStorage& storage,
                                          int lanes, std::span<const double> dt);
} // namespace dss
