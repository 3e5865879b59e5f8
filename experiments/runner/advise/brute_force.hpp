#pragma once
/// The cheapest configuration by trying them all: what advice is judged by.
#include "experiments/runner/advise/workbench.hpp"

#include <vector>

namespace dss {

class StepCosts;

struct BruteForceRun {
  Configuration configuration;
  double error = 0;  ///< true: against the solution
  double wall_s = 0; ///< of one run
};

/// Every model that has the degrees of freedom, every explicit method, every precision, with steps from the largest stable one down in ratios of 2^(1/4), and adaptive steps with
/// tolerances in ratios of 10^(1/2): run in the order of their predicted cost, until one has met the least tolerance and the next is predicted to cost half as much again. Of a
/// configuration whose error does not shrink by a twentieth when steps are halved, shorter steps are not tried.
/// @return all runs, failing ones left out
std::vector<BruteForceRun> brute_force(const Workbench& bench, StepCosts& costs, const Observed& solution,
                                       double least_tolerance);

} // namespace dss
