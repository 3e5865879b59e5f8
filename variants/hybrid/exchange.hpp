#pragma once
/// Halos between the members of a hybrid: through the memory of the process, once a step.
#include "variants/api.hpp"
#include "variants/message_order.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace dss {

/// All messages from one part to another. Two slots take turns: when the sender fills one again, it has had an answer to the other,
/// which the receiver gives only after it has read this one.
struct Channel {
  struct Slot {
    alignas(64) std::atomic<std::uint32_t> filled{0}; ///< number of the message that is here, counted from 1
    std::vector<std::byte> message;
  };
  std::array<Slot, 2> slots;
  MessageOrder order; ///< of the sender; empty where all members order a message alike
};

/// The channels between all parts, and what ends the waiting when a member cannot go on.
class Exchange {
public:
  explicit Exchange(bool is_crowded) : is_crowded_(is_crowded) {}
  /// Made for whoever asks first.
  Channel& channel(int from, int to);
  /// Returns when this message is here, or at once when it can no longer come.
  void await(const Channel::Slot& slot, std::uint32_t number) const;
  /// No more messages from now on: receivers leave their halo as it is, and end.
  void stop();
  bool is_stopped() const { return is_stopped_.load(std::memory_order_acquire); }

private:
  std::mutex mutex_; ///< of channels_ while members ask
  std::map<std::pair<int, int>, std::unique_ptr<Channel>> channels_;
  std::atomic<bool> is_stopped_{false};
  const bool is_crowded_; ///< more threads than processors: who waits, sleeps
};

/// The halo of one part. Also knows how long its member computes: from one step's receiving to the next, without waiting.
class MemberHalo final : public Halo {
public:
  MemberHalo(const Part& part, Exchange& exchange);
  /// The part's executor is there: its layouts, and the order of its messages if members differ.
  void open(Executor& executor, bool is_mixed, std::size_t number_bytes);
  /// All parts are open: where messages go.
  void connect(Executor& executor, std::size_t number_bytes);

  void send(Side side, int copy) override;
  void receive(Side side, int copy) override;

  void start_steps();
  void end_steps();
  /// Of each step since it was cleared [s].
  std::vector<double>& step_s() { return step_s_; }

private:
  struct Face {
    const Neighbour* neighbour;
    Side side;
    Channel *out, *in;
    std::vector<HaloLayout> send, receive; ///< by copy
    std::uint32_t sent = 0, received = 0;
  };
  void begin_step();

  Exchange& exchange_;
  std::vector<Face> faces_;
  std::vector<double> step_s_;
  bool is_stepping_ = false;                ///< else halos are exchanged for derivatives
  double step_began_s_ = -1, waited_s_ = 0; ///< of the step at hand; -1: none
};

} // namespace dss
