#pragma once
/// The solution of a scene at saved times, made by the oracle in long double and kept in a file, so that runs can be measured against it.
#include "experiments/runner/precision/saved_times.hpp"
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <functional>
#include <string>
#include <vector>

namespace dss {

struct Solution {
  std::string key; ///< what it is the solution of, and how it was found
  SavedTimes times;
  double error = 0;                        ///< estimated, relative, of displacements: how far it can serve
  double dt = 0;                           ///< of the finest run that it was found by [s]
  std::vector<std::vector<double>> states; ///< one a saved time, 13 numbers an element
};

/// How a solution is found.
struct SolutionRule {
  std::string integrator = "rk4";
  double tolerance = 1e-12; ///< steps become smaller until the estimated error is below it
  double most_steps = 1e6;  ///< or until a run would have more of them than this
};

/// A run of the oracle in long double from the initial state: its state at each saved time, in double.
/// @throws UnstableError if it leaves the finite numbers
std::vector<std::vector<double>> oracle_states(const Problem& problem, const Method& method, const SavedTimes& times,
                                               long steps_between);

/// Runs the oracle with steps h, h/2 and h/4 and extrapolates the last two by Richardson, which leaves an error of order p + 1, p the
/// method's. Its estimate is the distance to the extrapolation of the first two over 2^(p+1) - 1, in the norm of Accuracy::max
/// (accuracy.hpp); h falls until that is below the tolerance.
/// @param note  is told of each run; may be empty
Solution find_solution(const Problem& problem, const Method& method, const SolutionRule& rule, const SavedTimes& times,
                       const std::function<void(const std::string&)>& note);

/// Writes by temporary and rename. @throws InputError if it cannot be written
void write_solution(const std::string& path, const Solution& solution);
/// @throws InputError if the file cannot be read, is none of ours or is cut off
Solution read_solution(const std::string& path);

} // namespace dss
