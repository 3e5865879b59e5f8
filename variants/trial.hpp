#pragma once
/// How fast this process computes a part, without any exchange.
#include "variants/api.hpp"
#include "variants/part_cost.hpp"

namespace dss {

inline constexpr double trial_s = 4e-3; ///< of each timing, at least
inline constexpr std::size_t large_part_elements = 500'000;

/// Speed on one part of a decomposition, the best of some short timings of both schedules in turn: a shared machine is
/// never too fast. `setup` is of the whole problem.
/// @param rounds  timings of each schedule; half of them for large parts
NodeSpeed measure_speed(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition, int part,
                        int rounds = 8);

/// The same of all stages at once alone, which every executor of parts can do.
double measure_speed_at_once(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition, int part,
                             int rounds = 8);

} // namespace dss
