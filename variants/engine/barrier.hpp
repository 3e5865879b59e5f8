#pragma once
/// Where the threads of a team meet once a pass.
#include "variants/wake.hpp"

namespace dss {

/// Spins for about as long as a step of a small body takes, then sleeps: a thread that lost its core to another process
/// would else hold up the whole team for many time slices, because those that wait keep it from coming back.
/// (OpenMP's own barrier spins for milliseconds: measured 0.2 to 6 s for the same run beside one busy process.)
class Barrier {
public:
  explicit Barrier(int threads) : threads_(threads) {}
  void arrive_and_wait() {
    const unsigned round = round_.load(std::memory_order_acquire);
    if (waiting_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) {
      waiting_.store(0, std::memory_order_relaxed);
      store_and_wake(round_, round + 1);
      return;
    }
    for (int spins = 0; spins < most_spins; ++spins) {
      if (round_.load(std::memory_order_acquire) != round) return;
      __builtin_ia32_pause();
    }
    round_.wait(round, std::memory_order_acquire);
  }

private:
  static constexpr int most_spins = 2000; ///< 20 to 100 us
  const int threads_;
  alignas(64) std::atomic<int> waiting_{0};
  alignas(64) std::atomic<unsigned> round_{0};
};

} // namespace dss
