#pragma once
/// What a simulated job is told, as JSON: per strategy and part what is computed and exchanged. The runner writes it
/// (experiments/runner/simulation.cpp), every rank reads it.
#include "variants/mpi/part_json.hpp"

#include <string>
#include <vector>

namespace dss {

struct SimulationPlan {
  int steps = 0;
  std::string halo; ///< strategy to run, or "auto"
  std::vector<PlannedStrategy> strategies;
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedStrategy, name, exchanges, parts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SimulationPlan, steps, halo, strategies)

} // namespace dss
