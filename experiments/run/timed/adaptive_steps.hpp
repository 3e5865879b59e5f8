#pragma once
/// A run with adaptive steps: each step is as long as the tolerance of its error allows
/// (solver/numerics/step_control.hpp).
#include "solver/numerics/step_control.hpp"
#include "variants/api/api.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>

namespace dss {

/// Numbers of steps, and their times.
struct AdaptiveCounts {
  long accepted = 0, rejected = 0;
  double least_dt = std::numeric_limits<double>::infinity(),
         largest_dt = 0;   ///< of accepted steps [s]
  double wall_s = 0;       ///< time in try_step and accept_step only [s]
  double first_step_s = 0; ///< part of wall_s: the first attempted step [s]
};

/// Advances an executor by adaptive steps.
class AdaptiveSteps {
public:
  /// Starts at time 0. The executor must already have the problem's initial state.
  /// @param dt  length of the first step [s]
  /// @param end  end of the run [s]; steps that are too short relative to it are an error
  AdaptiveSteps(Executor& executor, const Problem& problem, const Method& method,
                const StepTolerance& tolerance, double dt, double end);
  /// Advances to exactly `stop` [s].
  /// @return one line if the run cannot continue, else empty
  std::optional<std::string> advance_to(double stop);
  /// Calls `visit` with the time [s] after each accepted step from now on.
  void visit_accepted(std::function<void(double)> visit) { visit_accepted_ = std::move(visit); }
  /// Calls `visit` before each step is tried from now on.
  void visit_before(std::function<void()> visit) { visit_before_ = std::move(visit); }
  const AdaptiveCounts& counts() const { return counts_; }
  double time() const { return time_; } ///< that was reached [s]
  /// Visits what a continued run needs (solver/io/kept_numbers.hpp). The times of the steps before
  /// are not part of it.
  template <class Visit>
  void each_kept(Visit&& visit) {
    visit(time_), visit(counts_.accepted), visit(counts_.rejected), visit(counts_.least_dt);
    visit(counts_.largest_dt);
    control_.each_kept(visit);
  }

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
  std::function<void()> visit_before_;
  std::function<void(double)> visit_accepted_;
};

} // namespace dss
