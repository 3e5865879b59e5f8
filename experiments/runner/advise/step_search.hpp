#pragma once
/// The fewest steps with which a method meets a tolerance.
#include <functional>
#include <string>

namespace dss {

struct StepTask {
  long first = 1;                    ///< steps between saved times at the largest step allowed
  int order = 1;                     ///< of the method
  double most_error = 0;             ///< to be met
  double most_cost = 0;              ///< of interest
  std::function<double(long)> error; ///< of a run with so many steps; infinite if it does not reach its end
  std::function<double(long)> cost;  ///< of one, predicted; grows with the steps
};

struct StepResult {
  enum class Verdict { meets, costs_more, stalls } verdict = Verdict::costs_more;
  long steps = 0;   ///< that meet the tolerance; else of the last run, 0 if there was none
  double error = 0; ///< with so many
  int runs = 0;
};

/// Searches by the method's order, later by the order that its errors show, until the number of steps that meets the tolerance is within 7 % (or the unit that numbers of steps are rounded to) of one that does
/// not. `costs_more`: the errors so far promise none at the most cost. `stalls`: half as many steps again do not lower the error by a fifth.
StepResult fewest_steps(const StepTask& task);

} // namespace dss
