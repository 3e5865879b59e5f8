#pragma once
/// The variant that computes on this rank, and what the record says of all ranks.
#include "variants/api/api.hpp"
#include "variants/mpi/world.hpp"

namespace dss {

/// How the setup wants to be distributed, or the default.
const Distribution& distribution_of(const Setup& setup);

/// Finds this rank's variant. Of a hybrid's members it puts device and threads into the setup.
/// @throws InputError if the variant is unknown or distributes itself
const Plugin& rank_plugin(Setup& setup, const World& world);

/// Number of ranks, and the names and instruction sets of their variants. Collective.
RankInfo info_of_ranks(const Plugin& own, World& world);

/// @throws InputError if the job has another number of ranks than was asked for
void require_ranks(const Distribution& asked, const World& world);

} // namespace dss
