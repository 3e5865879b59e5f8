#include "variants/halo_cost.hpp"

#include "variants/rounds.hpp"

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

using Transport = HaloStrategy::Transport;
constexpr int settling_steps = 6, replayed_steps = 8;

/// A network as one transport uses it.
class Link {
public:
  Link(const Network& network, Transport transport) : network_(network), transport_(transport) {}

  /// The message waits for its receiver, and the adapter fetches it.
  bool is_large(std::size_t bytes) const { return transport_ == Transport::messages && double(bytes) >= eager_bytes; }
  /// Of the processor, at each end.
  double busy_s(std::size_t bytes) const {
    if (transport_ == Transport::shared || double(bytes) >= eager_bytes) return 0;
    return network_.overhead_s + double(bytes) * network_.overhead_s_a_byte;
  }
  /// Of the adapter, if it has no other message.
  double wire_s(std::size_t bytes) const { return double(bytes) * network_.seconds_a_byte; }
  /// Memory that is shared takes no call of the receiver: half the way there and back of a message that is handed over.
  /// The latency of a message, as it is measured, has the processors' time at both ends in it.
  double flight_s() const {
    if (transport_ == Transport::shared) return network_.latency_s / 2;
    return std::max(0.0, network_.latency_s - 2 * network_.overhead_s);
  }

private:
  const Network& network_;
  const Transport transport_;
};

/// The clock of one part, and its messages of the exchange at hand.
class PartClock final : public Halo {
public:
  PartClock(const PlannedPart& part, const Link& link, bool meets)
      : part_(part), link_(link), meets_(meets), posted_s(part.faces.size()), arrival_s(part.faces.size()),
        sent_s(part.faces.size()) {}

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
  const bool meets_; ///< sendrecv: both ends are there for the whole message, which ends when it arrives

public:
  double now_s = 0, adapter_s = 0;         ///< adapter_s: when it has sent all before
  std::vector<double> posted_s, arrival_s; ///< by face
  std::vector<double> sent_s;              ///< large messages: when the adapter has fetched them
};

/// A message on its way through its sender's adapter.
struct Sending {
  std::size_t face;
  double start_s, left_s; ///< left_s: with the adapter to itself
  double end_s = 0;
};

/// Messages that are under way together have equal parts of the adapter.
void share_adapter(std::vector<Sending>& sendings) {
  std::ranges::sort(sendings, {}, &Sending::start_s);
  std::vector<Sending*> active;
  double now_s = 0;
  for (std::size_t next = 0; next < sendings.size() || !active.empty();) {
    const double start_s = next < sendings.size() ? sendings[next].start_s : INFINITY;
    const auto least = std::ranges::min_element(active, {}, &Sending::left_s);
    const double end_s = active.empty() ? INFINITY : now_s + (*least)->left_s * double(active.size());
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
        run_to_next_exchange(strategy_, planned_.parts[p].times, planned_.exchanges, clocks_[p], exchange_, false,
                             [&](double seconds) { clocks_[p].compute(seconds); });
      deliver();
    }
  }
  double latest_s() const { return std::ranges::max_element(clocks_, {}, &PartClock::now_s)->now_s; }

private:
  struct Edge {
    std::size_t part, face;
  };

  /// The same message, from the other end.
  Edge other_end(const Edge& edge) const {
    const std::size_t other = std::size_t(planned_.parts[edge.part].faces[edge.face].part);
    const auto& faces = planned_.parts[other].faces;
    const auto found = std::ranges::lower_bound(faces, int(edge.part), {}, &PlannedPart::Face::part);
    return {other, std::size_t(found - faces.begin())};
  }
  std::size_t bytes(const Edge& edge) const { return planned_.parts[edge.part].faces[edge.face].send_bytes; }

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

  /// When each message arrives of those that all parts have sent since the last call.
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

  /// Sends and receives of two neighbours at a time, in rounds.
  void meet() {
    std::vector<double> free_s;
    for (PartClock& clock : clocks_) free_s.push_back(clock.now_s);
    for (const std::vector<Edge>& round : rounds_)
      for (const Edge& one : round) {
        const Edge other = other_end(one);
        const std::size_t most = std::max(bytes(one), bytes(other));
        const double start_s = std::max(free_s[one.part], free_s[other.part]);
        const double end_s = start_s + 2 * link_.busy_s(most) + link_.wire_s(most) + link_.flight_s();
        free_s[one.part] = free_s[other.part] = end_s;
        clocks_[one.part].arrival_s[one.face] = clocks_[other.part].arrival_s[other.face] = end_s;
      }
  }

  const PlannedStrategy& planned_;
  const HaloStrategy& strategy_;
  const Link link_;
  std::vector<PartClock> clocks_;
  std::vector<std::vector<Edge>> rounds_; ///< sendrecv: each pair once
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
