#pragma once
/// The plan of a simulated job, as JSON: what each part computes and exchanges under each strategy.
/// The program writes it (experiments/run/cluster/simulation.cpp), and every rank reads it.
#include "variants/mpi/part_json.hpp"

#include <string>
#include <vector>

namespace dss {

/// A simulated job.
struct SimulationPlan {
  int steps = 0;
  std::string halo; ///< strategy to run, or "auto"
  std::vector<PlannedStrategy> strategies;
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedStrategy, name, exchanges, parts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SimulationPlan, steps, halo, strategies)

} // namespace dss
