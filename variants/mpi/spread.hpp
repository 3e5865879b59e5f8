#pragma once
/// From a problem to the part of each rank: decomposition, strategy, and the short trials that decide them.
#include "variants/api.hpp"
#include "variants/mpi/faults.hpp"
#include "variants/mpi/world.hpp"

#include <string>

namespace dss {

/// What every rank agrees on.
struct Spread {
  Decomposition decomposition;
  const HaloStrategy* halo = nullptr;
  std::string halo_reason; ///< predicted and tried times of an automatic choice
  Network network;         ///< that they are predicted with
};

/// Decides decomposition and strategy for a setup with a distribution. Collective.
/// @throws InputError for an unknown strategy, a decomposition that does not fit the ranks, ...
Spread spread(const Setup& setup, const Plugin& plugin, World& world, const Fault& fault);

} // namespace dss
