#pragma once
/// The clock for measurements and time limits.
#include <chrono>

namespace dss {

using Clock = std::chrono::steady_clock;

/// Time since `start` [s].
inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace dss
