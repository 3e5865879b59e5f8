#include "experiments/base/parallel.hpp"
#include "experiments/base/cores.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <omp.h>
#include <thread>
#include <vector>

namespace dss {

namespace {

/// Calls that threads take one after the other.
class Turns {
public:
  using Work = std::function<void(std::size_t, std::size_t)>;
  Turns(std::size_t count, const Work& work) : count_(count), work_(work) {}
  void take(std::size_t thread) {
    for (std::size_t n = next_++; n < count_; n = next_++) {
      try {
        work_(n, thread);
      } catch (...) {
        const std::lock_guard lock(of_failure_);
        if (!failure_) failure_ = std::current_exception();
        next_ = count_;
      }
    }
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

private:
  const std::size_t count_;
  const Work& work_;
  std::atomic<std::size_t> next_ = 0;
  std::exception_ptr failure_;
  std::mutex of_failure_;
};

} // namespace

void for_each_on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work) {
  const Turns::Work any_thread = [&](std::size_t n, std::size_t) { work(n); };
  Turns turns(count, any_thread);
  {
    std::vector<std::jthread> team; // joined at the end of the block
    const auto cores = std::size_t(usable_cores());
    for (std::size_t t = 1; t < std::min(cores, count); ++t)
      team.emplace_back([&turns, t] { turns.take(t); });
    turns.take(0);
  }
  turns.rethrow();
}

void for_each_on_team(int threads, std::size_t count,
                      const std::function<void(std::size_t, std::size_t)>& work) {
  Turns turns(count, work);
  if (threads == 1) {
    turns.take(0); // a region of one thread would make the regions inside it nested
  } else {
#pragma omp parallel num_threads(threads)
    turns.take(std::size_t(omp_get_thread_num()));
  }
  turns.rethrow();
}

} // namespace dss
