#pragma once
/// What a part's steps cost under each strategy, from its sizes and a node's speed: the compute side of halo_cost.hpp, for ranks and for
/// simulated nodes alike.
#include "solver/decomposition/part.hpp"
#include "solver/numerics/method.hpp"
#include "variants/halo_cost.hpp"

#include <string>

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

/// For the model. @param element_bytes  of a message, for an element
HaloCost halo_cost(const PartSize& size, const PartTimes& times, const HaloStrategy& strategy, int stages,
                   double element_bytes);

} // namespace dss
