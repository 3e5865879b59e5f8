#pragma once
/// Finds the cheapest configuration by trying all of them; advice is judged against it.
#include "experiments/run/advise/workbench.hpp"

#include <vector>

namespace dss {

class StepCosts;

/// One run of the search.
struct BruteForceRun {
  Configuration configuration;
  double error = 0;  ///< true error, against the solution
  double wall_s = 0; ///< of one run
};

/// Tries every model with the scene's degrees of freedom, every explicit method and every
/// precision. Steps shrink from the largest stable one in ratios of 2^(1/4); tolerances of adaptive
/// steps shrink in ratios of 10^(1/2). Runs are made in the order of their predicted cost. The
/// search ends once a run has met the least tolerance and the next is predicted to cost more than
/// 1.5 times as much. Steps are not shortened further if halving them lowers the error by less than
/// 5 %.
/// @return all runs that reached their end
std::vector<BruteForceRun> brute_force(const Workbench& bench, StepCosts& costs,
                                       const Observed& solution, double least_tolerance);

} // namespace dss
