#include "variants/cost/halo_cost.hpp"

#include "variants/cost/rounds.hpp"

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

using Transport = HaloStrategy::Transport;
constexpr int settling_steps = 6, replayed_steps = 8;

/// What a message costs on a network with one transport.
class Link {
public:
  Link(const Network& network, Transport transport) : network_(network), transport_(transport) {}

  /// The message waits until its receiver is ready; then the adapter fetches it.
  bool is_large(std::size_t bytes) const {
    return transport_ == Transport::messages && double(bytes) >= eager_bytes;
  }
  /// Time of the processor at each end [s].
  double busy_s(std::size_t bytes) const {
    if (transport_ == Transport::shared || double(bytes) >= eager_bytes) return 0;
    return network_.overhead_s + double(bytes) * network_.overhead_s_a_byte;
  }
  /// Time of the sender's adapter [s] if it has no other message.
  double wire_s(std::size_t bytes) const { return double(bytes) * network_.seconds_a_byte; }
  /// Time in flight [s]. Shared memory needs no call by the receiver, so half of a message's
  /// latency counts. The measured latency of a message includes the processors' time at both ends,
  /// which busy_s counts already.
  double flight_s() const {
    if (transport_ == Transport::shared) return network_.latency_s / 2;
    return std::max(0.0, network_.latency_s - 2 * network_.overhead_s);
  }

private:
  const Network& network_;
  const Transport transport_;
};

/// The clock of one part, and its messages in the present exchange.
class PartClock final : public Halo {
public:
  PartClock(const PlannedPart& part, const Link& link, bool meets)
      : part_(part), link_(link), meets_(meets), posted_s(part.faces.size()),
        arrival_s(part.faces.size()), sent_s(part.faces.size()) {}

  void compute(double seconds) { now_s += seconds; }
  void send(Side side, int) override {
    for (std::size_t f = 0; f < part_.faces.size(); ++f) {
      if (part_.faces[f].side != side) continue;
      if (!meets_) now_s += link_.busy_s(part_.faces[f].send_bytes);
      posted_s[f] = now_s;
    }
  }
  void receive(Side side, int) override {
    for (std::size_t f = 0; f < part_.faces.size(); ++f) {
      if (part_.faces[f].side != side) continue;
      now_s = std::max({now_s, arrival_s[f], sent_s[f]});
      if (!meets_) now_s += link_.busy_s(part_.faces[f].receive_bytes);
    }
  }

private:
  const PlannedPart& part_;
  const Link& link_;
  /// sendrecv: both ends are busy with the message until it arrives.
  const bool meets_;

public:
  /// adapter_s: when the adapter has sent all earlier messages.
  double now_s = 0, adapter_s = 0;
  std::vector<double> posted_s, arrival_s; ///< of each face
  std::vector<double> sent_s;              ///< large messages: when the adapter has fetched them
};

/// A message in the sender's adapter.
struct Sending {
  std::size_t face;
  double start_s, left_s; ///< left_s: transfer time left if the adapter had no other message
  double end_s = 0;
};

/// Sets end_s of each message. Messages that are sent at the same time share the adapter equally.
void share_adapter(std::vector<Sending>& sendings) {
  std::ranges::sort(sendings, {}, &Sending::start_s);
  std::vector<Sending*> active;
  double now_s = 0;
  for (std::size_t next = 0; next < sendings.size() || !active.empty();) {
    const double start_s = next < sendings.size() ? sendings[next].start_s : INFINITY;
    const auto least = std::ranges::min_element(active, {}, &Sending::left_s);
    const double end_s =
        active.empty() ? INFINITY : now_s + (*least)->left_s * double(active.size());
    const double event_s = std::min(start_s, end_s);
    for (Sending* one : active) one->left_s -= (event_s - now_s) / double(active.size());
    now_s = event_s;
    if (end_s <= start_s) {
      (*least)->end_s = now_s;
      active.erase(least);
    } else {
      active.push_back(&sendings[next++]);
    }
  }
}

class Replay {
public:
  Replay(const PlannedStrategy& planned, const HaloStrategy& strategy, const Network& network)
      : planned_(planned), strategy_(strategy), link_(network, strategy.transport) {
    const bool meets = strategy.transport == Transport::sendrecv;
    for (const PlannedPart& part : planned.parts) clocks_.emplace_back(part, link_, meets);
    if (meets) find_rounds();
    for (PartClock& clock : clocks_)
      for (const Side side : all_sides) clock.send(side, 0);
    deliver();
  }
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  void run(int steps) {
    for (int n = 0; n < steps * planned_.exchanges; ++n, ++exchange_) {
      for (std::size_t p = 0; p < clocks_.size(); ++p)
        run_to_next_exchange(strategy_, planned_.parts[p].times, planned_.exchanges, clocks_[p],
                             exchange_, false,
                             [&](double seconds) { clocks_[p].compute(seconds); });
      deliver();
    }
  }
  double latest_s() const {
    return std::ranges::max_element(clocks_, {}, &PartClock::now_s)->now_s;
  }

private:
  struct Edge {
    std::size_t part, face;
  };

  /// The other end of the same message.
  Edge other_end(const Edge& edge) const {
    const std::size_t other = std::size_t(planned_.parts[edge.part].faces[edge.face].part);
    const auto& faces = planned_.parts[other].faces;
    const auto found =
        std::ranges::lower_bound(faces, int(edge.part), {}, &PlannedPart::Face::part);
    return {other, std::size_t(found - faces.begin())};
  }
  std::size_t bytes(const Edge& edge) const {
    return planned_.parts[edge.part].faces[edge.face].send_bytes;
  }

  void find_rounds() {
    std::vector<std::pair<int, int>> edges;
    std::vector<Edge> places;
    for (std::size_t p = 0; p < planned_.parts.size(); ++p)
      for (std::size_t f = 0; f < planned_.parts[p].faces.size(); ++f)
        if (const int other = planned_.parts[p].faces[f].part; other > int(p))
          edges.emplace_back(int(p), other), places.push_back({p, f});
    const std::vector<int> round_of = colour_edges(edges, int(planned_.parts.size()));
    for (std::size_t n = 0; n < places.size(); ++n) {
      rounds_.resize(std::max(rounds_.size(), std::size_t(round_of[n]) + 1));
      rounds_[std::size_t(round_of[n])].push_back(places[n]);
    }
  }

  /// Finds the arrival times of all messages that the parts have sent since the last call.
  void deliver() {
    if (strategy_.transport == Transport::sendrecv) return meet();
    for (std::size_t p = 0; p < clocks_.size(); ++p) send_all(p);
  }
  void send_all(std::size_t part) {
    PartClock& sender = clocks_[part];
    std::vector<Sending> sendings;
    for (std::size_t f = 0; f < sender.posted_s.size(); ++f) {
      const std::size_t size = bytes({part, f});
      double start_s = std::max(sender.posted_s[f], sender.adapter_s);
      if (const Edge to = other_end({part, f}); link_.is_large(size))
        start_s = std::max(start_s, clocks_[to.part].posted_s[to.face]);
      sendings.push_back({f, start_s, link_.wire_s(size)});
    }
    share_adapter(sendings);
    for (const Sending& one : sendings) {
      const Edge to = other_end({part, one.face});
      clocks_[to.part].arrival_s[to.face] = one.end_s + link_.flight_s();
      sender.adapter_s = std::max(sender.adapter_s, one.end_s);
      if (link_.is_large(bytes({part, one.face}))) sender.sent_s[one.face] = one.end_s;
    }
  }

  /// sendrecv: pairs of neighbours exchange, one round after another.
  void meet() {
    std::vector<double> free_s;
    for (PartClock& clock : clocks_) free_s.push_back(clock.now_s);
    for (const std::vector<Edge>& round : rounds_)
      for (const Edge& one : round) {
        const Edge other = other_end(one);
        const std::size_t most = std::max(bytes(one), bytes(other));
        const double start_s = std::max(free_s[one.part], free_s[other.part]);
        const double end_s =
            start_s + 2 * link_.busy_s(most) + link_.wire_s(most) + link_.flight_s();
        free_s[one.part] = free_s[other.part] = end_s;
        clocks_[one.part].arrival_s[one.face] = clocks_[other.part].arrival_s[other.face] = end_s;
      }
  }

  const PlannedStrategy& planned_;
  const HaloStrategy& strategy_;
  const Link link_;
  std::vector<PartClock> clocks_;
  std::vector<std::vector<Edge>> rounds_; ///< sendrecv: each pair of neighbours once
  int exchange_ = 0;
};

} // namespace

double predicted_step_s(const PlannedStrategy& planned, const Network& network) {
  Replay replay(planned, *find_halo_strategy(planned.name), network);
  replay.run(settling_steps);
  const double settled_s = replay.latest_s();
  replay.run(replayed_steps);
  return (replay.latest_s() - settled_s) / replayed_steps;
}

} // namespace dss
