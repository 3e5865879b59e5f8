#pragma once
/// Fibres that take turns on one thread, in an order that a seed decides.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <ucontext.h>
#include <utility>
#include <vector>

namespace dss::test {

/// Nobody can go on, and not all have ended.
struct Deadlock : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs bodies as fibres. Only one runs at a time, and only wait() changes turns, so a run with one
/// seed is the same each time.
class Fibres {
public:
  explicit Fibres(std::uint64_t seed) : random_(seed) {}
  void add(std::function<void()> body) {
    fibres_.push_back(std::make_unique<Fibre>(Fibre{std::move(body)}));
  }
  /// Runs all to their ends. @throws Deadlock, or the first error of a body that it let through
  void run() {
    running_ = this;
    for (const auto& fibre : fibres_) {
      ::getcontext(&fibre->context);
      fibre->context.uc_stack.ss_sp = fibre->stack.data();
      fibre->context.uc_stack.ss_size = fibre->stack.size();
      fibre->context.uc_link = &main_;
      ::makecontext(&fibre->context, &Fibres::enter, 0);
    }
    while (Fibre* next = chosen()) {
      present_ = next;
      ::swapcontext(&main_, &next->context);
      if (next->error) std::rethrow_exception(next->error);
    }
    if (!std::ranges::all_of(fibres_, [](const auto& fibre) { return fibre->has_ended; }))
      throw Deadlock("all fibres wait");
  }
  /// Gives the turn away; goes on at some turn at which this is true. Call it from a fibre.
  void wait(std::function<bool()> is_ready) {
    present_->is_ready = std::move(is_ready);
    ::swapcontext(&present_->context, &main_);
  }

private:
  struct Fibre {
    std::function<void()> body;
    std::function<bool()> is_ready = [] { return true; };
    bool has_ended = false;
    std::exception_ptr error{};
    ucontext_t context{};
    std::vector<char> stack = std::vector<char>(1 << 20);
  };
  static void enter() {
    Fibre& fibre = *running_->present_;
    try {
      fibre.body();
    } catch (...) {
      fibre.error = std::current_exception();
    }
    fibre.has_ended = true;
  }
  Fibre* chosen() {
    std::vector<Fibre*> ready;
    for (const auto& fibre : fibres_)
      if (!fibre->has_ended && fibre->is_ready()) ready.push_back(fibre.get());
    return ready.empty() ? nullptr : ready[random_() % ready.size()];
  }

  static inline Fibres* running_ = nullptr;
  std::mt19937_64 random_;
  std::vector<std::unique_ptr<Fibre>> fibres_; ///< contexts must not move
  Fibre* present_ = nullptr;
  ucontext_t main_{};
};

} // namespace dss::test
