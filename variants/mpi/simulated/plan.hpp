#pragma once
/// What a simulated job is told, as JSON: per strategy and part what is computed and exchanged. The runner writes it
/// (experiments/runner/simulation.cpp), every rank reads it.
#include "variants/part_cost.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// What a part computes and exchanges in a step of one strategy, on the node that is simulated.
struct PlannedPart {
  PartTimes times;
  struct Face {
    int part = 0;
    Side side = Side::among;
    std::size_t send_bytes = 0, receive_bytes = 0; ///< in one exchange
  };
  std::vector<Face> faces;
};

struct PlannedStrategy {
  std::string name;
  int exchanges = 1; ///< a step
  std::vector<PlannedPart> parts;
};

struct SimulationPlan {
  int steps = 0;
  std::string halo; ///< strategy to run, or "auto"
  std::vector<PlannedStrategy> strategies;
};

NLOHMANN_JSON_SERIALIZE_ENUM(Side, {{Side::lower, "lower"}, {Side::upper, "upper"}, {Side::among, "among"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedPart::Face, part, side, send_bytes, receive_bytes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PartTimes, compute_s, inner_s, upper_s, edge_s)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedPart, times, faces)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedStrategy, name, exchanges, parts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SimulationPlan, steps, halo, strategies)

} // namespace dss
