#include "variants/sparse/step_factors.hpp"

#include "solver/memory.hpp"

#include <fmt/format.h>

#include <chrono>

namespace dss {

void factorise_step(const Factors::Matrix& lower, Factors& factors, FactorInfo& info) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  if (factors.analyse(lower))
    require_memory(factors.bytes(), fmt::format("factors of {} unknowns", lower.rows()),
                   "give another --variant");
  factors.compute(lower);
  info.time_s += std::chrono::duration<double>(Clock::now() - start).count();
  info.bytes = factors.bytes();
  ++info.count;
}

} // namespace dss
