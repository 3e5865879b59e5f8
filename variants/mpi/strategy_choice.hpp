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

/// Whether a strategy does something of its own with so many threads a rank: a team computes all rows at once, so that
/// there are no edges that could be done before the rest.
bool is_possible(const HaloStrategy& strategy, int threads);

/// Collective; all ranks choose the same. @param speed  of this rank on its part
StrategyChoice choose_strategy(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition,
                               const NodeSpeed& speed, World& world, const Fault& fault);

} // namespace dss
