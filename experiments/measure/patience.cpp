#include "experiments/measure/patience.hpp"
#include "experiments/base/clock.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <thread>
#include <utility>

namespace dss {

Patience::Patience(double most_s, Progress& progress, std::function<std::string()> disturbance)
    : most_s_(most_s), progress_(progress), disturbance_(std::move(disturbance)) {}

void Patience::wait() {
  std::string why = disturbance_();
  if (why.empty()) return;
  const double most_s = std::min(0.1 * most_s_, most_s_ - spent_s());
  if (most_s <= 0) return;
  progress_.note(fmt::format("waiting for a quiet machine, at most {}: {}",
                             duration_text(std::max(1.0, most_s)), why));
  ++waits_;
  const auto start = Clock::now();
  while (!why.empty() && seconds_since(start) < most_s) {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    why = disturbance_();
  }
  waited_s_ += seconds_since(start);
}

void Patience::spend(double repetition_s) {
  repeated_s_ += repetition_s;
  ++repetitions_;
}

std::string Patience::report() const {
  if (waits_ == 0 && repetitions_ == 0) return "";
  return fmt::format("waited {} times for a quiet machine, {:.0f} s; repeated {} disturbed "
                     "repetitions, {:.0f} s; at most {:.0f} s together",
                     waits_, waited_s_, repetitions_, repeated_s_, most_s_);
}

} // namespace dss
