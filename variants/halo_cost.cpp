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
  const double exchange_s = latencies * network.latency_s + cost.bytes * network.seconds_a_byte;
  const double communication_s = cost.exchanges * exchange_s;
  return cost.compute_s + (strategy.is_overlapped ? std::max(0.0, communication_s - cost.hiding_s) : communication_s);
}

} // namespace dss
