#pragma once
#include <chrono>

namespace dss {

/// Time since some moment in the past [s].
inline double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace dss
