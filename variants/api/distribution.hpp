#pragma once
/// How a problem is distributed over ranks, and by which strategies the parts exchange halos.
#include <span>
#include <string>
#include <string_view>

namespace dss {

/// When and by which means parts exchange halos. variants/mpi/README.md describes each strategy.
struct HaloStrategy {
  enum class Transport { sendrecv, messages, shared };
  std::string_view name;
  /// true: after every stage; the halo has one layer for each sweep of a stage (step_sweeps.hpp).
  /// false: once a step; the halo then has one layer for each sweep of the step, and the stages of
  /// halo elements are recomputed.
  bool is_every_stage;
  bool is_overlapped; ///< see PartSetup
  Transport transport;
  std::string_view what; ///< one line for people

  /// Exchanges in one step of a method with this number of stages.
  int exchanges(int stages) const { return is_every_stage ? stages : 1; }
  /// Whether the strategy makes sense with this number of threads a rank. Overlap once a step does
  /// not: several threads compute all rows at once, so no edge is finished before the rest.
  bool is_possible(int threads) const { return threads == 1 || is_every_stage || !is_overlapped; }
};

/// All strategies.
std::span<const HaloStrategy> halo_strategies();
/// @return the strategy of this name, or null
const HaloStrategy* find_halo_strategy(std::string_view name);
/// The strategy that --halo names.
/// @param threads  threads of each rank
/// @throws InputError if the name is unknown, or the strategy is not possible with these threads
const HaloStrategy& asked_halo_strategy(const std::string& name, int threads);

/// How the caller wants a problem to be distributed.
struct Distribution {
  int ranks = 1;
  std::string variant = "auto"; ///< the variant that computes each part
  /// A decomposition method, or the path of a decomposition file.
  std::string decomposition = "strips";
  std::string halo = "auto"; ///< a strategy; auto: the fastest in a trial
  bool is_measured = false;  ///< parts in proportion to each rank's measured speed; else equal
};

/// Cost of a message of b bytes: latency_s + b seconds_a_byte on the network. Messages that one
/// rank sends at the same time share its bandwidth. The processors at both ends are busy for
/// overhead_s + b overhead_s_a_byte each, except with messages so large that the network adapter
/// fetches them.
struct Network {
  double latency_s = 0, seconds_a_byte = 0;
  double overhead_s = 0, overhead_s_a_byte = 0;
};

/// How a problem was distributed in fact.
struct RankInfo {
  int ranks = 1;
  std::string variant, isa, decomposition, halo;
  bool has_fma = false;
  double imbalance = 1;    ///< own elements of the largest part divided by the mean over parts
  std::string halo_reason; ///< predicted and tried times of an automatic choice
  Network network;         ///< measured for an automatic choice, else zeros
};

/// What one rank exchanged in all calls of advance.
/// Sent by this rank.
struct Traffic {
  double messages = 0, bytes = 0;
  double wait_s = 0; ///< time in exchanges [s]
};

} // namespace dss
