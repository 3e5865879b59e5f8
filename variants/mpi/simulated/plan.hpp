#pragma once
/// What a simulated job is told, as JSON: per strategy and part what is computed and exchanged. The runner writes it
/// (experiments/runner/simulation.cpp), every rank reads it.
#include "solver/decomposition/part.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// What a part computes and exchanges in a step of one strategy. Times [s], on the node that is simulated.
struct PlannedPart {
  double compute_s = 0; ///< of a step: all passes
  double inner_s = 0;   ///< every stage: what needs no halo, of a step
  double upper_s = 0;   ///< overlapped, once a step: the pass of the upper edge (0: not split) ...
  double edge_s = 0;    ///< ... and from the start of the lower pass until the lower edge is done
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
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedPart, compute_s, inner_s, upper_s, edge_s, faces)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedStrategy, name, exchanges, parts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SimulationPlan, steps, halo, strategies)

} // namespace dss
