#pragma once
/// Runs independent work on several cores.
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>

namespace dss {

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

/// Calls work(0) ... work(count - 1), each once, in any order and in parallel. The threads end with
/// this call, so that they do not disturb the next timing.
/// @throws the exception of the first failing call, after the running calls have ended; no further
/// calls are started
void for_each_on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work);

} // namespace dss
