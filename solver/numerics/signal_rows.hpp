#pragma once
/// Signals sampled at the stage times of a run, by the core and in double, so that every variant sees the same numbers.
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <vector>

namespace dss {

/// Width of a row: frame acceleration x, y, z, then one value for each of problem.loads.
inline std::size_t signal_count(const Problem& problem) { return 3 + problem.loads.size(); }

/// Values at the stage times (first_step + n + node[s]) * dt of steps n = 0 .. steps - 1, step after step, one row
/// each, and a last row at (first_step + steps) * dt.
std::vector<double> signal_rows(const Problem& problem, const Method& method, double dt, long first_step, long steps);

/// The rows of a single step of dt from time t [s]: one for each stage.
std::vector<double> stage_signals(const Problem& problem, const Method& method, double t, double dt);

} // namespace dss
