#include "solver/memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <sys/resource.h>

namespace dss {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number in a file; infinite if there is none ("max").
double number_in(const std::string& path) {
  std::ifstream file(path);
  double value = 0;
  return file >> value ? value : unlimited;
}

/// MemAvailable of /proc/meminfo [bytes].
double left_by_kernel() {
  std::ifstream file("/proc/meminfo");
  double kib = 0;
  for (std::string key, rest; file >> key; std::getline(file, rest))
    if (key == "MemAvailable:" && file >> kib) return 1024 * kib;
  return unlimited;
}

/// What the limit of a cgroup leaves [bytes]. A container sees its own group at the root.
double left_by_group(const std::string& limit, const std::string& used) {
  const double most = number_in("/sys/fs/cgroup/" + limit);
  const double now = number_in("/sys/fs/cgroup/" + used);
  return most < unlimited && now < unlimited ? std::max(0.0, most - now) : unlimited;
}

} // namespace

double available_memory() {
  double left =
      std::min({left_by_kernel(), left_by_group("memory.max", "memory.current"),
                left_by_group("memory/memory.limit_in_bytes", "memory/memory.usage_in_bytes")});
  rlimit space{};
  if (::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    left = std::min(left, double(space.rlim_cur));
  return left;
}

} // namespace dss
