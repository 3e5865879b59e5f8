#pragma once
/// --halo auto: the model of halo_cost.hpp finds the strategies that may be the fastest, and a
/// trial decides among them.
#include "variants/api/api.hpp"
#include "variants/cost/part_cost.hpp"
#include "variants/mpi/faults.hpp"
#include "variants/mpi/world.hpp"

#include <string>

namespace dss {

/// A choice with its reason.
struct StrategyChoice {
  const HaloStrategy* halo = nullptr;
  std::string reason; ///< predicted and tried times of a step
  Network network;    ///< measured for these predictions
};

/// Chooses a strategy, the same on all ranks. Collective.
/// @param speed  of this rank on its part
StrategyChoice choose_strategy(const Setup& setup, const Plugin& plugin,
                               const Decomposition& decomposition, const NodeSpeed& speed,
                               World& world, const Fault& fault);

} // namespace dss
