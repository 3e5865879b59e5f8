#pragma once
/// Finds the fewest steps with which a method meets a tolerance.
#include <functional>
#include <string>

namespace dss {

/// The method, its limits, and how to run it.
struct StepTask {
  long first = 1;        ///< steps between saved times at the largest allowed step
  int order = 1;         ///< order of the method
  double most_error = 0; ///< tolerance of the error
  double most_cost = 0;  ///< largest cost that is of interest
  /// Error of a run with this many steps; infinite if the run does not reach its end.
  std::function<double(long)> error;
  std::function<double(long)> cost; ///< predicted cost of a run; grows with the steps
};

/// The result of the search.
struct StepResult {
  enum class Verdict { meets, costs_more, stalls } verdict = Verdict::costs_more;
  long steps = 0; ///< steps that meet the tolerance; else those of the last run, or 0 without a run
  double error = 0; ///< error with that many steps
  int runs = 0;
};

/// Searches by the method's order at first, then by the order that its errors show. Ends if the
/// passing number of steps is within 7 % of a failing one, or within the unit to which numbers of
/// steps are rounded.
/// `costs_more`: no number of steps up to the largest cost is expected to pass.
/// `stalls`: 1.5 times as many steps leave more than 0.8 of the error.
StepResult fewest_steps(const StepTask& task);

} // namespace dss
