#pragma once
/// The expected state of a run after some steps. The oracle computes it once; it is kept in a file,
/// and every timed run is checked against it.
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"
#include "solver/numerics/method.hpp"

#include <string>
#include <vector>

namespace dss {

/// State of the oracle after `steps` steps. It is computed in long double, because the variant
/// `reference` is the oracle in double and must not be compared with itself. It is stored in
/// double.
struct OracleState {
  std::string key; ///< what the state belongs to: scene, overrides, method, step
  long steps = 0;
  std::vector<double> state;
};

/// Runs the oracle from the initial state, with the rotations of a model's equations (rotation_of).
/// @throws UnstableError if the state becomes non-finite
OracleState compute_oracle_state(const Problem& problem, const Method& method, Rotation rotation,
                                 double dt, long steps, std::string key);

/// Runs the oracle for `steps` steps from `state`, which is the state at step `first_step`. The
/// method restarts there, which is exact for Runge-Kutta methods.
std::vector<double> continue_by_oracle(const Problem& problem, const Method& method,
                                       Rotation rotation, double dt, long first_step, long steps,
                                       const std::vector<double>& state);

/// Writes a temporary file and renames it. @throws InputError if it cannot be written
void write_oracle_state(const std::string& path, const OracleState& state);
/// @throws InputError if the file cannot be read, has another format or is cut off
OracleState read_oracle_state(const std::string& path);

} // namespace dss
