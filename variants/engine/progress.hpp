#pragma once
/// How far a thread has come in its tasks, for others that wait for some of them.
#include "variants/engine/barrier.hpp"
#include "variants/engine/seams.hpp"

namespace dss {

/// Counts events of one thread. Counters may overflow, so they are compared by their difference.
class Progress {
public:
  /// No thread may wait meanwhile.
  /// @param is_crowded  there are more threads than cores
  void reset(bool is_crowded) {
    count_.store(0, std::memory_order_relaxed);
    is_crowded_ = is_crowded;
  }
  /// Tells that the event of this number, and all before it, have happened.
  void reach(std::uint32_t event) { store_and_wake(count_, event); }
  /// Returns as soon as an event has happened.
  void await(std::uint32_t event) const {
    const auto is_reached = [&] {
      return is_at_least(count_.load(std::memory_order_acquire), event);
    };
    if (spin_until(is_crowded_, is_reached)) return;
    for (std::uint32_t now = count_.load(std::memory_order_acquire); !is_at_least(now, event);
         now = count_.load(std::memory_order_acquire))
      count_.wait(now, std::memory_order_acquire);
  }
  /// Lets all others go on for good: this thread has ended early.
  void leave() { reach(count_.load(std::memory_order_relaxed) + (1u << 30)); }

private:
  static bool is_at_least(std::uint32_t count, std::uint32_t event) {
    return std::int32_t(count - event) >= 0;
  }
  alignas(64) std::atomic<std::uint32_t> count_{0};
  bool is_crowded_ = false;
};

/// Goes along with the tasks of a pass of a block: waits for other blocks, and tells them.
class SeamWatch {
public:
  /// @param pass      how many passes were computed since all progress was reset
  /// @param progress  of each block
  SeamWatch(const Seams& seams, int block, long pass, std::span<Progress> progress)
      : seams_(seams), progress_(progress), pass_(std::uint32_t(pass)), own_(std::size_t(block)),
        waits_(seams.waits(block)), events_(seams.events(block)) {}
  void before(int task) {
    for (; !waits_.empty() && waits_.front().task == task; waits_ = waits_.subspan(1)) {
      const Seams::Wait& wait = waits_.front();
      progress_[std::size_t(wait.block)].await(
          number(seams_.events(wait.block).size(), pass_ - std::uint32_t(wait.is_for_pass_before),
                 wait.event));
    }
  }
  void after(int task) {
    if (met_ == events_.size() || events_[met_] != task) return;
    progress_[own_].reach(number(events_.size(), pass_, int(++met_)));
  }

private:
  /// Events are numbered through all passes.
  static std::uint32_t number(std::size_t events, std::uint32_t pass, int event) {
    return pass * std::uint32_t(events) + std::uint32_t(event);
  }
  const Seams& seams_;
  const std::span<Progress> progress_;
  const std::uint32_t pass_;
  const std::size_t own_;
  std::span<const Seams::Wait> waits_;
  const std::span<const int> events_;
  std::size_t met_ = 0;
};

} // namespace dss
