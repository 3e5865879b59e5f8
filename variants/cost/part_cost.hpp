#pragma once
/// What a part computes and exchanges in a step under each strategy, from the part's sizes and the
/// speed of a node. Used to choose a strategy and to simulate clusters.
#include "kernels/model.hpp"
#include "solver/decomposition/part.hpp"
#include "solver/numerics/method.hpp"
#include "variants/api/distribution.hpp"
#include "variants/api/step_sweeps.hpp"

#include <string>
#include <vector>

namespace dss {

/// How fast a node computes [elements times stages / s], halo elements included.
struct NodeSpeed {
  std::string name;
  double at_once = 0;        ///< all stages in one pass over the rows
  double stage_by_stage = 0; ///< with an exchange after each stage
  double of(const HaloStrategy& strategy) const {
    return strategy.is_every_stage ? stage_by_stage : at_once;
  }
};

/// Times of one step of a part [s].
struct PartTimes {
  double compute_s = 0; ///< all passes together
  double inner_s = 0;   ///< every-stage strategies: rows that read no halo
  /// Overlap once a step: the separate pass of the upper edge; 0: the step is not split.
  double upper_s = 0;
  /// Overlap once a step: from the start of the lower pass until the lower edge is finished.
  double edge_s = 0;
};

/// Layers of halo that a strategy needs: one for each sweep of a stage, or of a step.
int halo_depth(const HaloStrategy& strategy, StepSweeps sweeps);

/// Elements times stages that a part computes in a step. Rows are computed whole, and a halo row
/// only in the stages whose result a later stage reads.
double element_stages(const PartSize& size, const HaloStrategy& strategy, StepSweeps sweeps);

/// @param size   the part with halo_depth layers
/// @param reach  largest distance of two linked elements [rows]
PartTimes part_times(const PartSize& size, const HaloStrategy& strategy, StepSweeps sweeps,
                     int reach, const NodeSpeed& speed);

/// Times and messages of a part in a step under one strategy.
struct PlannedPart {
  PartTimes times;
  struct Face {
    int part = 0;
    Side side = Side::among;
    std::size_t send_bytes = 0, receive_bytes = 0; ///< in one exchange
  };
  std::vector<Face> faces; ///< ascending by part
};
PlannedPart plan_part(const PartSize& size, const PartTimes& times, Precision precision);

/// A step of all parts under one strategy.
struct PlannedStrategy {
  std::string name;  ///< of the HaloStrategy
  int exchanges = 1; ///< in a step: one, or the number of stages
  std::vector<PlannedPart> parts;
};

} // namespace dss
