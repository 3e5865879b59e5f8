#pragma once
/// What the plan and the final state say of a run, and whether its energy can be right.
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/timed/run_result.hpp"

#include <vector>

namespace dss {

/// Above this size, a second copy of the state would need too much memory.
constexpr std::size_t energy_elements = 2'000'000;

/// Larger scenes have no energy balance: it holds the state several times.
constexpr std::size_t balanced_elements = 250'000;

/// Signals are computed for this many steps at once, so steps are advanced in such chunks.
constexpr long signal_steps = 256;
/// Likewise of methods with leaps, which end with each call.
constexpr long leap_steps = 4096;

/// Steps between looks at the energy on the way: a whole number of chunks.
long energy_look_interval(std::size_t elements, long steps);

/// The rotations with which the oracle has the equations of a run by this model.
Rotation equations_of(const RunPlan& plan, Model model);

/// False if the request says so, for scenes that are too large, for runs against a solution, whose
/// errors say more, and for Rotation::small, whose equations keep no energy.
bool has_energy_balance(const RunPlan& plan, const RunRequest& request, Rotation equations);

/// What happened to a run that became unstable after a step, counted from the start, and what to
/// do.
std::string breakdown_reason(const RunPlan& plan, const Outcome& outcome, long step);

/// @throws InputError if the energy at the start is beyond the range of numbers
void require_finite_start(const Problem& problem, Rotation rotation);

/// Runs of at most so many element-steps and steps are computed once more, with a look at the
/// energy after each step.
bool is_balanced_by_steps(std::size_t elements, long steps);

/// Says what computes: schedule, memory, workers, ranks and their variant, members of a hybrid.
void describe_executor(Executor& executor, const Plugin& plugin, RunResult& result);

/// A result with everything that is known before the run.
RunResult described(const RunPlan& plan, const RunRequest& request);

/// Finds the energy of the final state, its drift and its stability limit.
void describe_state(const RunPlan& plan, Rotation rotation, const std::vector<double>& state,
                    RunResult& result);

/// Judges whether displacements and energy are finite: a state may be finite and what follows from
/// it may not. @throws InputError if that holds from the start
void judge_range(const RunPlan& plan, Rotation rotation, RunResult& result);

/// Judges the energy balance of the result, if it has one: the root alone has.
void judge_energy(const RunPlan& plan, RunResult& result);

} // namespace dss
