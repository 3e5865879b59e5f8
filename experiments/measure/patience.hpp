#pragma once
/// Effort for clean timings: a study waits for a quiet machine and repeats what was disturbed, but
/// only up to a stated time.
#include "experiments/base/progress.hpp"

#include <functional>
#include <string>

namespace dss {

/// What is left of the effort, and what it was spent on.
class Patience {
public:
  /// @param most_s  time [s] for waiting and repeating together
  /// @param disturbance  tells what disturbs the machine now; empty if it is quiet
  Patience(double most_s, Progress& progress, std::function<std::string()> disturbance);

  /// Waits until the machine is quiet, for at most a tenth of the whole effort and no longer than
  /// what is left of it. Says in the progress that it waits, and for what.
  void wait();
  /// True if the effort allows to repeat something that takes this time [s].
  bool allows(double repetition_s) const { return spent_s() + repetition_s <= most_s_; }
  /// Accounts for a repetition that was disturbed and is repeated.
  void spend(double repetition_s);
  /// "waited 12 s for a quiet machine, repeated 7 disturbed repetitions in 9 s (of at most 60 s)";
  /// empty if nothing was spent.
  std::string report() const;

private:
  double spent_s() const { return waited_s_ + repeated_s_; }

  double most_s_, waited_s_ = 0, repeated_s_ = 0;
  long waits_ = 0, repetitions_ = 0;
  Progress& progress_;
  std::function<std::string()> disturbance_;
};

} // namespace dss
