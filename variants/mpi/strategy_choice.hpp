#pragma once
/// --halo auto: the model of halo_cost.hpp says which strategies may be the fastest, a trial says which one is.
#include "variants/api.hpp"
#include "variants/mpi/faults.hpp"
#include "variants/mpi/world.hpp"
#include "variants/part_cost.hpp"

#include <string>

namespace dss {

struct StrategyChoice {
  const HaloStrategy* halo = nullptr;
  std::string reason; ///< predicted and tried times of a step
  Network network;    ///< that they are predicted with
};

/// Collective; all ranks choose the same. @param speed  of this rank on its part
StrategyChoice choose_strategy(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition,
                               const NodeSpeed& speed, World& world, const Fault& fault);

} // namespace dss
