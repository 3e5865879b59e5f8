#pragma once
/// The reference that errors are estimated against if the solution is unknown: runs with halved
/// steps until they agree.
#include "experiments/run/advise/workbench.hpp"

#include <string>
#include <vector>

namespace dss {

/// One run of the halving.
struct ReferenceLevel {
  long steps_between = 0;
  double change = 0; ///< distance to the next finer level; 0 for the finest
  double wall_s = 0;
};

/// The finest run and its estimated error.
struct ReferenceRun {
  Configuration configuration; ///< of the finest level
  Observed observed;           ///< of the finest level
  double error = 0;            ///< estimated error of the finest level
  std::vector<ReferenceLevel> levels;
  /// reason why it cannot serve for a tolerance near the requested one; empty if it can
  std::string failure;
  double least_tolerance = 0; ///< after a failure: smallest tolerance that it can serve; 0: unknown
};

/// Largest error of a reference, as a share of the tolerance: the goal, and the bar above which it
/// is useless.
inline constexpr double reference_goal = 1.0 / 30, reference_bar = 1.0 / 5;

/// Halves the step of a run until the estimated error of the finer run is below reference_goal of
/// the tolerance.
/// Let d be a change and d' the change before it. The error of the finer run is estimated as r d /
/// (1 - r) with r = d / d', but r >= 1/8. A method of order p has r = 2^-p; loads with kinks give a
/// larger r.
/// If changes stop shrinking, the error is the larger of the last two changes. The cause is
/// rounding, or a motion that amplifies small differences.
/// @param start  a step near the stability limit, f64, of an exact model
/// @param budget_s  limit of the time in steps [s]
ReferenceRun find_reference(const Workbench& bench, const Configuration& start, double tolerance,
                            double budget_s);

} // namespace dss
