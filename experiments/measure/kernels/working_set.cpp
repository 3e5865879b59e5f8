#include "experiments/measure/kernels/working_set.hpp"

#include "variants/api/cache_sizes.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace dss {

WorkingSet working_set(const std::string& level, int threads) {
  const std::size_t own = std::size_t(threads);
  if (level == "L1") return {level, l1_bytes() / 2, ""};
  if (level == "L2") return {level, l2_bytes() / 2, ""};
  if (level == "L3") {
    const std::size_t bytes = 4 * l2_bytes();
    if (2 * bytes * own > l3_bytes())
      return {level, 0, fmt::format("L3 of {} MB is too small beside L2", l3_bytes() >> 20)};
    return {level, bytes, ""};
  }
  const std::size_t memory =
      std::size_t(::sysconf(_SC_PHYS_PAGES)) * std::size_t(::sysconf(_SC_PAGE_SIZE));
  if (8 * l3_bytes() > memory)
    return {level, 0,
            fmt::format("twice the L3 of {} MB is more than a quarter of the memory",
                        l3_bytes() >> 20)};
  return {level, 2 * l3_bytes() / own, ""};
}

std::string level_of(std::size_t bytes) {
  if (bytes <= l1_bytes()) return "L1";
  if (bytes <= l2_bytes()) return "L2";
  return bytes <= l3_bytes() ? "L3" : "memory";
}

} // namespace dss
