#include "variants/hybrid/team.hpp"

#include <utility>

namespace dss {

Team::Team(std::size_t members) {
  for (std::size_t member = 0; member < members; ++member)
    threads_.emplace_back([this, member] { serve(member); });
}

Team::~Team() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  begun_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Team::run(const Work& work) {
  std::unique_lock lock(mutex_);
  work_ = &work;
  busy_ = threads_.size();
  ++turn_;
  begun_.notify_all();
  ended_.wait(lock, [&] { return busy_ == 0; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void Team::serve(std::size_t member) {
  std::unique_lock lock(mutex_);
  for (long turn = 1;; ++turn) {
    begun_.wait(lock, [&] { return is_over_ || turn_ == turn; });
    if (is_over_) return;
    const Work& work = *work_;
    lock.unlock();
    std::exception_ptr error;
    try {
      work(member);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (error && !error_) error_ = error;
    if (--busy_ == 0) ended_.notify_all();
  }
}

} // namespace dss
