#include "solver/memory.hpp"

#include "solver/error.hpp"

#include <algorithm>
#include <fmt/format.h>
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

/// MemAvailable of a /proc/meminfo [bytes].
double left_by_kernel(const std::string& path) {
  std::ifstream file(path);
  double kib = 0;
  for (std::string key, rest; file >> key; std::getline(file, rest))
    if (key == "MemAvailable:" && file >> kib) return 1024 * kib;
  return unlimited;
}

/// Pages of files in a memory.stat [bytes]: the kernel takes them back when it needs memory.
double file_pages(const std::string& path, const std::string& prefix) {
  std::ifstream file(path);
  double bytes = 0, value = 0;
  for (std::string key; file >> key >> value;)
    if (key == prefix + "active_file" || key == prefix + "inactive_file") bytes += value;
  return bytes;
}

/// What the limit of a cgroup leaves [bytes]. A container sees its own group at the root.
double left_by_group(const std::string& folder, const char* limit, const char* used,
                     const char* prefix) {
  const double most = number_in(folder + limit), now = number_in(folder + used);
  if (most == unlimited || now == unlimited) return unlimited;
  return std::max(0.0, most - now + file_pages(folder + "memory.stat", prefix));
}

} // namespace

double available_memory(const std::string& root) {
  const std::string groups = root + "/sys/fs/cgroup/";
  double left = std::min({left_by_kernel(root + "/proc/meminfo"),
                          left_by_group(groups, "memory.max", "memory.current", ""),
                          left_by_group(groups + "memory/", "memory.limit_in_bytes",
                                        "memory.usage_in_bytes", "total_")});
  rlimit space{};
  if (::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    left = std::min(left, double(space.rlim_cur));
  return left;
}

void require_memory(double bytes, const std::string& what, const std::string& advice) {
  const double free = available_memory();
  if (bytes > free)
    throw InputError(fmt::format("{} need {:.3g} GB or more; this machine has {:.3g} GB free; {}",
                                 what, 1e-9 * bytes, 1e-9 * free, advice));
}

} // namespace dss
