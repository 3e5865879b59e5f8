#pragma once
/// A halo whose neighbours are threads or fibres of the same process: parts without MPI.
#include "variants/api/message_order.hpp"
#include "variants/api/step_sweeps.hpp"

#include <array>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

namespace dss::test {

/// Letters from part to part, in order.
class Mailboxes {
public:
  using Letter = std::vector<std::byte>;
  virtual ~Mailboxes() = default;
  virtual void put(int from, int to, Letter letter) = 0;
  /// Waits for the next one.
  virtual Letter take(int from, int to) = 0;
};

/// Of threads.
class ThreadMailboxes final : public Mailboxes {
public:
  void put(int from, int to, Letter letter) override {
    const std::lock_guard lock(mutex_);
    boxes_[{from, to}].push_back(std::move(letter));
    filled_.notify_all();
  }
  Letter take(int from, int to) override {
    std::unique_lock lock(mutex_);
    auto& box = boxes_[{from, to}];
    for (int yields = 0; yields < most_yields && box.empty();
         ++yields) { // sleeping and waking would take most of a test's time
      lock.unlock();
      std::this_thread::yield();
      lock.lock();
    }
    filled_.wait(lock, [&] { return !box.empty(); });
    Letter letter = std::move(box.front());
    box.pop_front();
    return letter;
  }

private:
  static constexpr int most_yields = 100;
  std::mutex mutex_;
  std::condition_variable filled_;
  std::map<std::pair<int, int>, std::deque<Letter>> boxes_;
};

class LocalHalo final : public Halo {
public:
  /// @param has_wrong_bit  one bit of every letter is flipped
  LocalHalo(const Part& part, Mailboxes& mailboxes, bool has_wrong_bit)
      : part_(part), mailboxes_(mailboxes), has_wrong_bit_(has_wrong_bit) {}
  /// All layouts must be known before the first exchange. The first letter says how many lanes the
  /// sender has, and how it orders the others.
  void attach(Executor& executor, Precision precision) {
    const std::size_t bytes = number_bytes(precision);
    for (const Neighbour& neighbour : part_.neighbours) {
      MessageOrder own = message_order(executor, neighbour.send, 0, bytes);
      own.push_back(std::size_t(halo_lanes(executor)));
      Mailboxes::Letter letter(own.size() * sizeof own[0]);
      std::memcpy(letter.data(), own.data(), letter.size());
      mailboxes_.put(part_.index, neighbour.part, std::move(letter));
    }
    for (const Neighbour& neighbour : part_.neighbours) {
      const Mailboxes::Letter letter = mailboxes_.take(neighbour.part, part_.index);
      MessageOrder theirs(letter.size() / sizeof(MessageOrder::value_type));
      std::memcpy(theirs.data(), letter.data(), letter.size());
      const std::array lanes{std::size_t(halo_lanes(executor)), theirs.back()};
      theirs.pop_back();
      for (int copy = 0; copy < halo_copies(executor); ++copy) {
        send_[{neighbour.part, copy}] = halo_layout(executor, neighbour.send, copy);
        HaloLayout& receive = receive_[{neighbour.part, copy}];
        receive = halo_layout(executor, neighbour.receive, copy);
        if (are_mixed(lanes))
          receive = reordered(receive, message_order(executor, neighbour.receive, copy, bytes),
                              theirs, bytes);
      }
    }
  }

  void send(Side side, int copy) override {
    for (const Neighbour& neighbour : part_.neighbours) {
      if (side_of(part_, neighbour) != side) continue;
      const HaloLayout& layout = send_.at({neighbour.part, copy});
      Mailboxes::Letter letter(layout.size);
      for (const auto& piece : layout.pieces)
        std::memcpy(&letter[piece.offset], piece.at, piece.count);
      if (has_wrong_bit_) letter.back() ^= std::byte(1);
      mailboxes_.put(part_.index, neighbour.part, std::move(letter));
    }
  }
  void receive(Side side, int copy) override {
    for (const Neighbour& neighbour : part_.neighbours) {
      if (side_of(part_, neighbour) != side) continue;
      const HaloLayout& layout = receive_.at({neighbour.part, copy});
      const Mailboxes::Letter letter = mailboxes_.take(neighbour.part, part_.index);
      if (letter.size() != layout.size)
        throw std::logic_error("the letter is not as long as the halo");
      for (const auto& piece : layout.pieces)
        std::memcpy(piece.at, &letter[piece.offset], piece.count);
    }
  }

private:
  const Part& part_;
  Mailboxes& mailboxes_;
  bool has_wrong_bit_;
  std::map<std::pair<int, int>, HaloLayout> send_, receive_; ///< by part and copy
};

} // namespace dss::test
