#include "variants/halo_cost.hpp"

#include <algorithm>

namespace dss {

double predicted_step_s(const HaloStrategy& strategy, const HaloCost& cost, const Network& network) {
  if (cost.faces == 0) return cost.compute_s;
  using Transport = HaloStrategy::Transport;
  // Memory that is shared takes no call of the receiver: half the way there and back of a message that is handed over.
  const double latencies = strategy.transport == Transport::sendrecv ? cost.faces
                           : strategy.transport == Transport::shared ? 0.5
                                                                     : 1;
  const double communication_s = cost.exchanges * (latencies * network.latency_s + cost.bytes * network.seconds_a_byte);
  const double message_bytes = cost.bytes / cost.faces;
  const double overhead_s =
      message_bytes > eager_bytes
          ? 0
          : 2 * cost.exchanges * cost.faces * (network.overhead_s + message_bytes * network.overhead_s_a_byte);
  return cost.compute_s + (strategy.is_overlapped ? overhead_s + std::max(0.0, communication_s - cost.hiding_s)
                                                  : std::max(overhead_s, communication_s));
}

} // namespace dss
