#pragma once
/// Halos between the members of a hybrid, through the memory of the process, once a step.
#include "variants/api/api.hpp"
#include "variants/api/message_order.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace dss {

/// All messages from one part to another. Two slots are used in turn, so messages n and n + 2 share
/// one. The sender writes n + 2 after it has received the neighbour's message n + 1, which the
/// neighbour sends only after it has read message n.
struct Channel {
  struct Slot {
    /// Number of the message in the slot, counted from 1.
    alignas(64) std::atomic<std::uint32_t> filled{0};
    std::vector<std::byte> message;
  };
  std::array<Slot, 2> slots;
  MessageOrder order; ///< the sender's order; empty if all members order messages alike
};

/// The channels between all parts. Ends the waiting if a member cannot continue.
class Exchange {
public:
  explicit Exchange(bool is_crowded) : is_crowded_(is_crowded) {}
  /// The channel between two parts. The first call makes it.
  Channel& channel(int from, int to);
  /// Returns when this message is in the slot, or at once if it can no longer come.
  void await(const Channel::Slot& slot, std::uint32_t number) const;
  /// Ends all messages: receivers no longer wait, and leave their halos as they are.
  void stop();
  bool is_stopped() const { return is_stopped_.load(std::memory_order_acquire); }

private:
  std::mutex mutex_; ///< guards channels_ while members ask for them
  std::map<std::pair<int, int>, std::unique_ptr<Channel>> channels_;
  std::atomic<bool> is_stopped_{false};
  const bool is_crowded_; ///< more threads than processors: waiting threads sleep
};

/// The halo of one part. It also measures how long its member computes: from one step's receive to
/// the next, without waiting [s].
class MemberHalo final : public Halo {
public:
  MemberHalo(const Part& part, Exchange& exchange);
  /// Takes the layouts of the part's executor, and the order of its messages if members differ.
  void open(Executor& executor, bool is_mixed, std::size_t number_bytes);
  /// Finds the places of received messages. Call it when all parts are open.
  void connect(Executor& executor, std::size_t number_bytes);

  void send(Side side, int copy) override;
  void receive(Side side, int copy) override;

  void start_steps();
  void end_steps();
  /// Time of each step since the list was cleared [s].
  std::vector<double>& step_s() { return step_s_; }

private:
  struct Face {
    const Neighbour* neighbour;
    Side side;
    Channel *out, *in;
    std::vector<HaloLayout> send, receive; ///< of each copy
    std::uint32_t sent = 0, received = 0;
  };
  void begin_step();

  Exchange& exchange_;
  std::vector<Face> faces_;
  std::vector<double> step_s_;
  bool is_stepping_ = false;                ///< false: halos are exchanged for derivatives
  double step_began_s_ = -1, waited_s_ = 0; ///< of the present step; -1: none
};

} // namespace dss
