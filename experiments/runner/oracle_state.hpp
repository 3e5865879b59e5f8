#pragma once
/// The expected state of a run after some steps, computed once by the oracle and kept in a file, so that every timed
/// run can be checked against it.
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"
#include "solver/numerics/method.hpp"

#include <string>
#include <vector>

namespace dss {

/// State of the oracle after `steps` steps: computed in long double, so that the variant `reference`, which is the
/// oracle in double, is compared with something else than itself; kept in double.
struct OracleState {
  std::string key; ///< what it is the state of: scene, overrides, method, step
  long steps = 0;
  std::vector<double> state;
};

/// Runs the oracle from the initial state, with the equations of a model (rotation_of). @throws UnstableError if it leaves the finite numbers
OracleState compute_oracle_state(const Problem& problem, const Method& method, Rotation rotation, double dt, long steps,
                                 std::string key);

/// State `steps` steps after `state` at step `first_step`, by the oracle. The method starts anew there, which is exact
/// for Runge-Kutta methods.
std::vector<double> continue_by_oracle(const Problem& problem, const Method& method, Rotation rotation, double dt,
                                       long first_step, long steps, const std::vector<double>& state);

/// Writes by temporary and rename. @throws InputError if it cannot be written
void write_oracle_state(const std::string& path, const OracleState& state);
/// @throws InputError if the file cannot be read, is none of ours or is cut off
OracleState read_oracle_state(const std::string& path);

} // namespace dss
