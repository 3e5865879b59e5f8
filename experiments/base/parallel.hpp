#pragma once
/// Runs independent work on several cores.
#include <cstddef>
#include <functional>

namespace dss {

/// Calls work(0) ... work(count - 1), each once, in any order and in parallel. The threads end with
/// this call, so that they do not disturb the next timing.
/// @throws the exception of the first failing call, after the running calls have ended; no further
/// calls are started
void for_each_on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work);

/// Calls work(n, thread) for n = 0 ... count - 1 likewise, on a team of OpenMP's threads, which
/// stay between two calls: for work that is timed.
void for_each_on_team(int threads, std::size_t count,
                      const std::function<void(std::size_t, std::size_t)>& work);

} // namespace dss
