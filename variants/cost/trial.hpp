#pragma once
/// Measures how fast this process computes a part, without any exchange.
#include "variants/api/api.hpp"
#include "variants/cost/part_cost.hpp"

namespace dss {

inline constexpr double trial_s = 4e-3; ///< shortest duration of one timing [s]
/// Steps that take at least trial_s, found by doubling.
/// @param run_s  function from a number of steps to the seconds that they took
template <class RunSeconds>
long trial_steps(RunSeconds&& run_s) {
  long steps = 1;
  while (run_s(steps) < trial_s && steps < 1 << 16) steps *= 2;
  return steps;
}
inline constexpr std::size_t large_part_elements = 500'000;

/// Speed on one part of a decomposition, for both schedules. The best of several short timings
/// counts, because other load on the machine can only make a timing longer.
/// @param setup   of the whole problem
/// @param rounds  timings of each schedule; half as many for parts above large_part_elements
NodeSpeed measure_speed(const Setup& setup, const Plugin& plugin,
                        const Decomposition& decomposition, int part, int rounds = 8);

/// The same for the schedule "all stages in one pass" only, which every executor of parts has.
double measure_speed_at_once(const Setup& setup, const Plugin& plugin,
                             const Decomposition& decomposition, int part, int rounds = 8);

} // namespace dss
