#pragma once
/// How a problem is spread over ranks, and the strategies by which their parts exchange halos.
#include <span>
#include <string>
#include <string_view>

namespace dss {

/// A way to exchange halos.
struct HaloStrategy {
  enum class Transport { sendrecv, messages, shared };
  std::string_view name;
  bool is_every_stage; ///< one layer after every stage; else a layer a stage, once a step, and stages are recomputed
  bool is_overlapped;  ///< as in PartSetup
  Transport transport;
  std::string_view what; ///< one line for people

  /// Exchanges in a step of a method.
  int exchanges(int stages) const { return is_every_stage ? stages : 1; }
  /// Whether it does something of its own with so many threads a rank: a team computes all rows at once, so that there are no edges that
  /// could be done before the rest.
  bool is_possible(int threads) const { return threads == 1 || is_every_stage || !is_overlapped; }
};

/// sendrecv, overlap, deep, deep-overlap, shared.
std::span<const HaloStrategy> halo_strategies();
/// By name; null if there is none.
const HaloStrategy* find_halo_strategy(std::string_view name);
/// As asked for by --halo. @throws InputError if it is unknown, or not possible with so many threads a rank
const HaloStrategy& asked_halo_strategy(const std::string& name, int threads);

/// What a distributed variant is asked for.
struct Distribution {
  int ranks = 1;
  std::string variant = "auto";         ///< that computes each part
  std::string decomposition = "strips"; ///< a method, or the path of a decomposition file
  std::string halo = "auto";            ///< a strategy; auto: the fastest of a trial
  bool is_measured = false;             ///< parts in proportion to each rank's measured speed; else equal
};

/// A message of b bytes takes latency_s + b seconds_a_byte; messages of one rank share its bandwidth. At each end the
/// processor itself is busy with it for overhead_s + b overhead_s_a_byte, unless it is so large that the adapter fetches
/// it.
struct Network {
  double latency_s = 0, seconds_a_byte = 0;
  double overhead_s = 0, overhead_s_a_byte = 0;
};

/// What became of it.
struct RankInfo {
  int ranks = 1;
  std::string variant, isa, decomposition, halo;
  bool has_fma = false;
  double imbalance = 1;    ///< own elements of the largest part over the mean
  std::string halo_reason; ///< of an automatic choice: the predicted and tried times
  Network network;         ///< as measured for an automatic choice, else zeros
};

/// What one rank has exchanged in all calls of advance.
struct Traffic {
  double messages = 0, bytes = 0; ///< sent
  double wait_s = 0;              ///< in exchanges [s]
};

} // namespace dss
