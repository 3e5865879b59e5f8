#pragma once
/// A run whose steps are as long as the tolerated error allows (solver/numerics/step_control.hpp).
#include "solver/numerics/step_control.hpp"
#include "variants/api.hpp"

#include <limits>
#include <optional>
#include <string>

namespace dss {

struct AdaptiveCounts {
  long accepted = 0, rejected = 0;
  double least_dt = std::numeric_limits<double>::infinity(), largest_dt = 0; ///< of accepted steps [s]
  double wall_s = 0;                                                         ///< in try_step and accept_step alone
  double first_step_s = 0;                                                   ///< of it the first try
};

class AdaptiveSteps {
public:
  /// Starts from the problem's initial state, which the executor has, at time 0.
  /// @param dt  the first step that is tried [s]  @param end  of the run [s]: what a step must not be negligible beside
  AdaptiveSteps(Executor& executor, const Problem& problem, const Method& method, const StepTolerance& tolerance,
                double dt, double end);
  /// Steps until `stop` [s], exactly. @return why it cannot go on, if so: one line
  std::optional<std::string> advance_to(double stop);
  const AdaptiveCounts& counts() const { return counts_; }

private:
  bool step(double dt);
  std::string why_no_step(double dt);

  Executor& executor_;
  const Problem& problem_;
  const Method& method_;
  const StepTolerance tolerance_;
  const double end_;
  StepControl control_;
  double time_ = 0;
  AdaptiveCounts counts_;
};

} // namespace dss
