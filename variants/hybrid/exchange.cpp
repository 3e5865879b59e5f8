#include "variants/hybrid/exchange.hpp"

#include "variants/engine/wake.hpp"
#include "variants/hybrid/clock.hpp"
#include "variants/isa/architecture.hpp"

#include <sched.h>

namespace dss {

/// About 20 to 100 us: members in step differ by less, and sleeping costs as much.
constexpr int most_spins = 2000;
constexpr std::uint32_t stopped = std::uint32_t(-1); ///< fills a slot in place of a message number

Channel& Exchange::channel(int from, int to) {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<Channel>& found = channels_[{from, to}];
  if (found == nullptr) found = std::make_unique<Channel>();
  return *found;
}

void Exchange::await(const Channel::Slot& slot, std::uint32_t number) const {
  for (int spins = 0;; ++spins) {
    const std::uint32_t found = slot.filled.load(std::memory_order_acquire);
    if (found == number || is_stopped())
      return; // in this order: stop() changes the slot after the flag
    if (!is_crowded_ && spins < most_spins)
      isa::pause();
    else if (is_crowded_ && spins == 0)
      ::sched_yield();
    else
      slot.filled.wait(found, std::memory_order_acquire);
  }
}

void Exchange::stop() {
  is_stopped_.store(true, std::memory_order_seq_cst);
  for (const auto& [ends, channel] : channels_)
    for (Channel::Slot& slot : channel->slots) store_and_wake(slot.filled, stopped);
}

MemberHalo::MemberHalo(const Part& part, Exchange& exchange) : exchange_(exchange) {
  for (const Neighbour& neighbour : part.neighbours)
    faces_.push_back({&neighbour,
                      side_of(part, neighbour),
                      &exchange.channel(part.index, neighbour.part),
                      &exchange.channel(neighbour.part, part.index),
                      {},
                      {}});
}

void MemberHalo::open(Executor& executor, bool is_mixed, std::size_t number_bytes) {
  for (Face& face : faces_) {
    for (int copy = 0; copy < halo_copies(executor); ++copy) {
      face.send.push_back(halo_layout(executor, face.neighbour->send, copy));
      face.receive.push_back(halo_layout(executor, face.neighbour->receive, copy));
    }
    for (Channel::Slot& slot : face.out->slots) slot.message.resize(face.send.front().size);
    if (is_mixed) face.out->order = message_order(executor, face.neighbour->send, 0, number_bytes);
  }
}

void MemberHalo::connect(Executor& executor, std::size_t number_bytes) {
  for (Face& face : faces_) {
    if (face.in->slots[0].message.size() != face.receive.front().size)
      throw std::logic_error("halo: two members do not store the same numbers of an element");
    if (face.in->order.empty()) continue;
    for (int copy = 0; copy < halo_copies(executor); ++copy)
      face.receive[std::size_t(copy)] =
          reordered(face.receive[std::size_t(copy)],
                    message_order(executor, face.neighbour->receive, copy, number_bytes),
                    face.in->order, number_bytes);
  }
}

void MemberHalo::send(Side side, int copy) {
  if (exchange_.is_stopped()) return;
  for (Face& face : faces_) {
    if (face.side != side) continue;
    Channel::Slot& slot = face.out->slots[face.sent & 1];
    gather(face.send[std::size_t(copy)], slot.message.data());
    store_and_wake(slot.filled, ++face.sent);
  }
}

void MemberHalo::receive(Side side, int copy) {
  if (is_stepping_ && side == faces_.front().side) begin_step();
  for (Face& face : faces_) {
    if (face.side != side) continue;
    const Channel::Slot& slot = face.in->slots[face.received & 1];
    if (slot.filled.load(std::memory_order_acquire) != ++face.received) {
      const double began_s = now_s();
      exchange_.await(slot, face.received);
      waited_s_ += now_s() - began_s;
    }
    if (exchange_.is_stopped()) return;
    scatter(face.receive[std::size_t(copy)], slot.message.data());
  }
}

void MemberHalo::start_steps() {
  is_stepping_ = true;
  step_began_s_ = -1;
}

void MemberHalo::begin_step() {
  const double now = now_s();
  if (step_began_s_ >= 0) step_s_.push_back(now - step_began_s_ - waited_s_);
  step_began_s_ = now;
  waited_s_ = 0;
}

void MemberHalo::end_steps() {
  if (step_began_s_ >= 0) begin_step();
  is_stepping_ = false;
}

} // namespace dss
