#pragma once
/// When a run writes checkpoints.
#include "experiments/base/clock.hpp"
#include "experiments/run/plan/run_plan.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace dss {

/// The time or the steps between two checkpoints.
struct CheckpointInterval {
  double seconds = 0; ///< 0: by steps
  long steps = 0;     ///< 0: by time
};

/// Reads "60s" or a number of steps. @throws InputError for anything else
CheckpointInterval parse_checkpoint_interval(const std::string& text);

/// Refuses what cannot be continued, before anything is computed.
/// @throws InputError with the reason and what to give
void require_sound_checkpoints(const RunRequest& request, const RunPlan& plan);

/// For a variant that cannot save what its methods keep. @throws InputError
[[noreturn]] void refuse_saving(const RunRequest& request, std::string_view variant);
/// For a state of --check-state that the interrupted run passed. @throws InputError
[[noreturn]] void refuse_passed_state(const RunRequest& request, long step);

/// Tells when the next checkpoint is due.
class CheckpointClock {
public:
  /// @param step  that the run starts at
  CheckpointClock(const CheckpointInterval& interval, long step)
      : interval_(interval), last_step_(step), last_(Clock::now()) {}
  bool is_due(long step) const {
    return interval_.steps > 0 ? step - last_step_ >= interval_.steps
                               : seconds_since(last_) >= interval_.seconds;
  }
  bool is_due_by_steps(long step) const { return interval_.steps > 0 && is_due(step); }
  void take(long step) { last_step_ = step, last_ = Clock::now(); }
  /// Steps from a step to where the next checkpoint is due; by time: `most`.
  long steps_left(long step, long most) const {
    return interval_.steps > 0 ? std::min(most, std::max(1L, interval_.steps - (step - last_step_)))
                               : most;
  }

private:
  CheckpointInterval interval_;
  long last_step_;
  Clock::time_point last_;
};

} // namespace dss
