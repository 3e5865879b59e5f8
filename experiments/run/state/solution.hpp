#pragma once
/// The solution of a scene at saved times. The oracle computes it in long double, or a variant in
/// double; it is kept in a file, and errors of runs are measured against it.
#include "experiments/run/state/saved_times.hpp"
#include "kernels/model.hpp"
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <functional>
#include <string>
#include <vector>

namespace dss {

/// States of a solution and their estimated error.
struct Solution {
  std::string key; ///< what it is the solution of, and how it was found
  SavedTimes times;
  double error = 0;                        ///< estimated, relative, of displacements
  double dt = 0;                           ///< step of the finest run [s]
  std::vector<std::vector<double>> states; ///< one per saved time, 13 numbers per element
};

/// How a solution is found.
struct SolutionRule {
  std::string integrator = "rk4";
  double tolerance = 1e-12;     ///< steps are shortened until the estimated error is below it
  double most_steps = 1e6;      ///< or until a run would have more steps
  std::string variant{};        ///< empty: the oracle
  Model model = Model::spatial; ///< of the variant

  /// What tells it from other rules: "rk4 to 1e-12".
  std::string key() const;
};

/// Runs the oracle in long double from the initial state. Returns its state at each saved time, in
/// double.
/// @throws UnstableError if the state becomes non-finite
std::vector<std::vector<double>> oracle_states(const Problem& problem, const Method& method,
                                               const SavedTimes& times, long steps_between);

/// The same by the rule's variant, in double, on all cores.
std::vector<std::vector<double>> variant_states(const Problem& problem, const Method& method,
                                                const SolutionRule& rule, const SavedTimes& times,
                                                long steps_between);

/// Runs the oracle, or the rule's variant, with steps h, h/2 and h/4 and extrapolates the last two
/// by Richardson. With a method of order p, an error of order p + 1 remains. It is estimated as the
/// distance to the extrapolation of the first two, divided by 2^(p+1) - 1, in the norm of
/// Accuracy::max (accuracy.hpp). h is reduced until the estimate is below the tolerance.
/// @param note  receives a line of text for each run; may be empty
Solution find_solution(const Problem& problem, const Method& method, const SolutionRule& rule,
                       const SavedTimes& times,
                       const std::function<void(const std::string&)>& note);

/// Writes a temporary file and renames it. @throws InputError if it cannot be written
void write_solution(const std::string& path, const Solution& solution);
/// @throws InputError if the file cannot be read, has another format or is cut off
Solution read_solution(const std::string& path);

} // namespace dss
