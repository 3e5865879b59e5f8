#pragma once
/// Signals sampled at the stage times of a run, by the core and in double. So every variant sees
/// the same numbers.
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <vector>

namespace dss {

/// Width of a row: frame acceleration x, y, z; one value for each of problem.loads; if the frame
/// rotates, its angular velocity and the derivative of it. Vectors are along the frame's axes.
inline std::size_t signal_count(const Problem& problem) {
  return 3 + problem.loads.size() + (problem.has_rotating_frame() ? 6 : 0);
}

/// One row: the values at time t [s].
std::vector<double> signals_at(const Problem& problem, double t);

/// Values at the stage times (first_step + n + node[s]) * dt of the steps n = 0 .. steps - 1: one
/// row for each stage, step after step, and a last row at (first_step + steps) * dt.
std::vector<double> signal_rows(const Problem& problem, const Method& method, double dt,
                                long first_step, long steps);

/// Rows of a single step of dt [s] from the time t [s], one for each stage.
std::vector<double> stage_signals(const Problem& problem, const Method& method, double t,
                                  double dt);

} // namespace dss
