#pragma once
/// What errors are estimated against where nobody knows the solution: runs with halved steps, until they agree.
#include "experiments/runner/advise/workbench.hpp"

#include <string>
#include <vector>

namespace dss {

/// One run of the halving.
struct ReferenceLevel {
  long steps_between = 0;
  double change = 0; ///< distance to the next finer level; of the finest 0
  double wall_s = 0;
};

struct ReferenceRun {
  Configuration configuration; ///< of the finest level
  Observed observed;           ///< of it
  double error = 0;            ///< its own, estimated
  std::vector<ReferenceLevel> levels;
  std::string failure;        ///< empty, or why it can serve for no tolerance near the one asked for
  double least_tolerance = 0; ///< that it can serve, if it failed; 0: unknown
};

/// Part of the tolerance that a reference's own error should be below, and that beyond which it is of no use.
inline constexpr double reference_goal = 1.0 / 30, reference_bar = 1.0 / 5;

/// Halves the step of a run until its change says that the finer run's error is below reference_goal of the tolerance. A change d after one of d' is
/// taken for an error r d / (1 - r) of the finer run, r = d / d', but at least 1/8: a method of order p has 2^-p, less where loads have kinks. Where changes
/// stop shrinking, the larger of the last two is the error: rounding, or a motion that amplifies whatever differs.
/// @param start  a step near the stability limit, f64, of a model that is exact  @param budget_s  of time in steps [s]
ReferenceRun find_reference(const Workbench& bench, const Configuration& start, double tolerance, double budget_s);

} // namespace dss
