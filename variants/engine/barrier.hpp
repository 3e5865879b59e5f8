#pragma once
/// Where the threads of a team meet once a pass.
#include "variants/wake.hpp"

#include <sched.h>

namespace dss {

/// Spins for about as long as a step of a small body takes, then sleeps: a thread that lost its core to another process
/// would else hold up the whole team for many time slices, because those that wait keep it from coming back.
/// (OpenMP's own barrier spins for milliseconds: measured 0.2 to 6 s for the same run beside one busy process.)
/// In a crowded team, of more threads than cores, those that wait give their core to those that they wait for: spinning, they kept it from them
/// (`verify`, whose teams have up to 7 threads, took 2.5 times as long on 2 cores), and waking a sleeper costs more (2.1 times).
class Barrier {
public:
  Barrier(int threads, bool is_crowded) : threads_(threads), is_crowded_(is_crowded) {}
  void arrive_and_wait() {
    const unsigned round = round_.load(std::memory_order_acquire);
    if (waiting_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) {
      waiting_.store(0, std::memory_order_relaxed);
      store_and_wake(round_, round + 1);
      return;
    }
    for (int spins = is_crowded_ ? most_spins - most_yields : 0; spins < most_spins; ++spins) {
      if (round_.load(std::memory_order_acquire) != round) return;
      if (is_crowded_)
        ::sched_yield();
      else
        __builtin_ia32_pause();
    }
    round_.wait(round, std::memory_order_acquire);
  }

private:
  static constexpr int most_spins = 2000; ///< 20 to 100 us
  static constexpr int most_yields = 100;
  const int threads_;
  const bool is_crowded_;
  alignas(64) std::atomic<int> waiting_{0};
  alignas(64) std::atomic<unsigned> round_{0};
};

} // namespace dss
