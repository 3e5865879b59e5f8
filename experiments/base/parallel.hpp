#pragma once
/// Runs independent work on a team of threads.
#include "solver/parallel.hpp"

#include <cstddef>
#include <functional>

namespace dss {

/// Calls work(n, thread) for n = 0 ... count - 1, each once, on a team of OpenMP's threads, which
/// stay between two calls: for work that is timed.
void for_each_on_team(int threads, std::size_t count,
                      const std::function<void(std::size_t, std::size_t)>& work);

} // namespace dss
