#pragma once
/// The barrier at which the threads of a team meet.
#include "variants/engine/wake.hpp"
#include "variants/isa/architecture.hpp"

#include <sched.h>

namespace dss {

/// Spins for about as long as a step of a small body takes, after which a thread should sleep.
/// Without sleep, one thread that loses its core to another process delays the whole team for many
/// time slices, because the spinning threads keep it from coming back. OpenMP's own barrier spins
/// for milliseconds. A team with more threads than cores is crowded: its waiting threads yield
/// their cores to the threads that they wait for, and sleep later. Measurements: README.md.
/// @return whether it is ready
template <class IsReady>
bool spin_until(bool is_crowded, IsReady&& is_ready) {
  constexpr int most_spins = 2000; // about 20 to 100 us
  constexpr int most_yields = 100;
  for (int spins = is_crowded ? most_spins - most_yields : 0; spins < most_spins; ++spins) {
    if (is_ready()) return true;
    if (is_crowded)
      ::sched_yield();
    else
      isa::pause();
  }
  return false;
}

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
    const auto is_next = [&] { return round_.load(std::memory_order_acquire) != round; };
    if (!spin_until(is_crowded_, is_next)) round_.wait(round, std::memory_order_acquire);
  }

private:
  const int threads_;
  const bool is_crowded_;
  alignas(64) std::atomic<int> waiting_{0};
  alignas(64) std::atomic<unsigned> round_{0};
};

} // namespace dss
