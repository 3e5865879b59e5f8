#pragma once
/// Finds the part of each rank for a problem: the decomposition, the halo strategy, and the short
/// trials that decide them.
#include "variants/api/api.hpp"
#include "variants/mpi/faults.hpp"
#include "variants/mpi/world.hpp"

#include <string>

namespace dss {

/// What all ranks agree on.
struct Spread {
  Decomposition decomposition;
  const HaloStrategy* halo = nullptr;
  std::string halo_reason; ///< predicted and tried times of an automatic choice
  Network network;         ///< measured for these predictions
};

/// Decides the decomposition and the strategy for a setup with a distribution. Collective.
/// @throws InputError if the strategy is unknown, the decomposition does not fit the ranks, or the
///   job has another number of ranks than asked for
Spread spread(const Setup& setup, const Plugin& plugin, World& world, const Fault& fault);

} // namespace dss
