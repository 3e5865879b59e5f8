#pragma once
/// Compares the states of a run with the oracle.
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/timed/run_result.hpp"

#include <span>
#include <vector>

namespace dss {

/// Two comparisons: with the expected state of the plan, and of a longer run over its last steps,
/// which the oracle repeats.
class OracleCheck {
public:
  /// @param plan  outlives this object
  explicit OracleCheck(const RunPlan& plan) : plan_(plan) {}
  /// Steps at which look() wants the state, in any order; none without an expected state.
  std::vector<long> stops() const;
  bool is_wanted(long step) const;
  /// Called at each of these steps, in ascending order.
  /// @param equations  rotations with which the oracle has the equations of the run
  void look(long step, std::span<const double> state, Rotation equations, CheckResult& check);

private:
  /// True if the last steps are checked. Only Runge-Kutta runs can be: a leapfrog method cannot
  /// restart from a state without its half-step velocities.
  bool has_tail() const;
  long tail_start() const;

  const RunPlan& plan_;
  std::vector<double> tail_state_;
};

/// Makes a result "wrong" if its comparison with the oracle failed.
void judge_check(RunResult& result);

} // namespace dss
