#pragma once
/// What a part computes and exchanges in a step of each strategy, from its sizes and a node's speed: for the choice of a strategy and for
/// simulated nodes alike.
#include "solver/decomposition/part.hpp"
#include "solver/model/model.hpp"
#include "solver/numerics/method.hpp"
#include "variants/distribution.hpp"

#include <string>
#include <vector>

namespace dss {

/// How fast a node computes, in elements and stages a second, halo elements included.
struct NodeSpeed {
  std::string name;
  double at_once = 0;        ///< all stages in one pass
  double stage_by_stage = 0; ///< with an exchange after each
  double of(const HaloStrategy& strategy) const { return strategy.is_every_stage ? stage_by_stage : at_once; }
};

/// Times of a step of a part [s].
struct PartTimes {
  double compute_s = 0; ///< all passes
  double inner_s = 0;   ///< every stage: what needs no halo, of a step
  double upper_s = 0;   ///< overlapped, once a step: the pass of the upper edge (0: not split) ...
  double edge_s = 0;    ///< ... and from the start of the lower pass until the lower edge is done
};

/// Layers of halo that a strategy needs.
int halo_depth(const HaloStrategy& strategy, const Method& method);

/// Elements times stages that a part computes in a step: rows whole, each as often as a later stage needs it.
double element_stages(const PartSize& size, const HaloStrategy& strategy, int stages);

/// @param size  of the part with halo_depth layers  @param reach  largest distance in rows of two linked elements
PartTimes part_times(const PartSize& size, const HaloStrategy& strategy, int stages, int reach, const NodeSpeed& speed);

/// What a part computes and exchanges in a step of one strategy.
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

/// A step of all parts.
struct PlannedStrategy {
  std::string name;  ///< of a HaloStrategy
  int exchanges = 1; ///< a step: the stages, or one
  std::vector<PlannedPart> parts;
};

} // namespace dss
