#pragma once
/// Time that passes, for what is timed and for limits.
#include <chrono>

namespace dss {

using Clock = std::chrono::steady_clock;

/// [s]
inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace dss
