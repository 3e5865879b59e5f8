#pragma once
/// A wrong bit in the state of a run, for tests of what is found.
#include "experiments/run/plan/run_plan.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace dss {

/// DSSBENCH_FLIP=STEP:ELEMENT:NUMBER:BIT flips a bit of a number that the method keeps of an
/// element (variants/api/kept_state.hpp), once, before that step. A fifth part, `:stays`, sets it
/// before each later chunk of steps too, as broken memory does. Bit 0 is the last of the mantissa.
class FlippedBit {
public:
  /// Empty if the variable is not set. @throws InputError if it is set to anything else
  static std::optional<FlippedBit> of_environment();
  /// @throws InputError if the run has no such step or its state no such number
  void require_within(const RunPlan& plan, Executor& executor) const;
  /// Before a chunk of steps.
  void apply(Executor& executor, long step, Precision precision);
  /// Steps from a step to the wrong bit, at most `most`.
  long steps_left(long step, long most) const {
    return step < step_ ? std::min(most, step_ - step) : most;
  }

private:
  long step_ = 0;
  std::size_t element_ = 0;
  int number_ = 0, bit_ = 0;
  bool stays_ = false, is_done_ = false;
};

} // namespace dss
