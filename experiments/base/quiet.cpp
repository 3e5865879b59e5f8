#include "experiments/base/quiet.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fstream>
#include <thread>

namespace dss {
namespace {

/// Threads that run or could run, without this one; 0 if unknown.
int others_running() {
  std::ifstream stream("/proc/loadavg");
  double last_1_min = 0, last_5_min = 0, last_15_min = 0;
  int running = 1;
  stream >> last_1_min >> last_5_min >> last_15_min >> running;
  return stream ? running - 1 : 0;
}

} // namespace

std::string disturbance() {
  int least = others_running();
  for (int look = 1; look < 3 && least > 0; ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    least = std::min(least, others_running());
  }
  if (least <= 0) return "";
  return least == 1 ? "another thread is running"
                    : fmt::format("{} other threads are running", least);
}

} // namespace dss
