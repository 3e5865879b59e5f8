#include "experiments/run/timed/run.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/output.hpp"
#include "experiments/run/timed/timed_run.hpp"
#include "solver/error.hpp"
#include "solver/model/energy.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/numerics/stability_at_state.hpp"
#include "variants/isa/denormals.hpp"

#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

/// Above this size, a second copy of the state would need too much memory.
constexpr std::size_t energy_elements = 2'000'000;

RunResult described(const RunPlan& plan, const RunRequest& request) {
  RunResult result;
  result.scene = plan.scene.name;
  result.variant = plan.plugin->name;
  result.isa = plan.plugin->isa;
  result.has_fma = plan.plugin->has_fma;
  result.model = name(plan.model);
  result.precision = name(plan.precision);
  result.integrator = plan.method->name;
  result.stages = plan.method->stages;
  result.rotation = name(plan.rotation);
  result.model_choice = plan.model_choice;
  result.threads = request.threads;
  result.elements = plan.scene.problem.lattice.element_count;
  result.links = plan.scene.problem.link_count();
  result.steps = plan.steps;
  result.warmup_steps = request.warmup_steps;
  result.dt_s = plan.dt;
  result.stability_limit_s = plan.stability_limit;
  result.end_s = double(plan.steps) * plan.dt;
  result.adaptive = plan.adaptive;
  if (!plan.method->is_implicit()) result.evaluations = double(plan.steps) * plan.method->stages;
  return result;
}

/// Relative change of the energy from the start to the end. Empty if energy is not conserved or is
/// zero at the start.
std::optional<double> energy_drift(const Problem& problem, Rotation rotation,
                                   std::optional<double> final_j) {
  if (!final_j || !conserves_energy(problem)) return {};
  const double start_j = total_energy(problem, initial_state(problem), rotation);
  if (start_j == 0) return {};
  return *final_j / start_j - 1;
}

/// Step limit of the final state [s]. If it matters, it refers to the sharp limit at rest: the
/// plan's may be a bound on the safe side.
double limit_of_end(const RunPlan& plan, Rotation rotation, const std::vector<double>& state) {
  const Problem& problem = plan.scene.problem;
  const double limit = stable_step_at_state(problem, rotation, state, plan.stability_limit);
  if (plan.dt <= limit) return limit;
  return limit / plan.stability_limit * stable_step(problem, *plan.method, true).dt;
}

/// Finds what the final state says of the run.
void describe_end(TimedRun& timed, const RunPlan& plan, RunResult& result) {
  const Problem& problem = plan.scene.problem;
  const std::size_t count = problem.lattice.element_count;
  const Rotation rotation = timed.equations();
  result.max_displacement_m = max_displacement(timed.executor(), count);
  result.digest = state_digest(timed.executor(), count, plan.precision);
  if (count > energy_elements) return;
  const std::vector<double> state = whole_state(timed.executor(), count);
  result.energy_j = total_energy(problem, state, rotation);
  if (result.model_report.promotions.empty())
    result.energy_drift = energy_drift(problem, rotation, result.energy_j);
  if (count <= stability_state_elements && !plan.adaptive && !plan.method->is_implicit())
    result.stability_limit_end_s = limit_of_end(plan, rotation, state);
}

void judge_check(RunResult& result) {
  const CheckResult& check = result.check;
  if (!check.is_done || check.is_passed()) return;
  result.status = "wrong";
  result.reason = check.tail_error && !(*check.tail_error <= check.tolerance)
                      ? fmt::format("error {:.3g} over the last steps exceeds the tolerance {:.3g}",
                                    *check.tail_error, check.tolerance)
                      : fmt::format("error {:.3g} ({}) exceeds the tolerance {:.3g}", check.error,
                                    check.how, check.tolerance);
}

/// A state may be finite and what follows from it may not.
/// @throws InputError if that holds from the start
void judge_range(const RunPlan& plan, Rotation rotation, RunResult& result) {
  if (std::isfinite(result.max_displacement_m) && std::isfinite(result.energy_j.value_or(0)))
    return;
  const Problem& problem = plan.scene.problem;
  if (!std::isfinite(total_energy(problem, initial_state(problem), rotation)))
    throw InputError(fmt::format("{}: the energy at the start is beyond the range of numbers; give "
                                 "masses, lengths and velocities in SI units",
                                 problem.name));
  result.status = "unstable";
  result.reason = fmt::format("{}: displacements or energy at the end are beyond the range of "
                              "numbers; take --dt below {:.6g} s",
                              problem.name, 0.5 * plan.dt);
}

/// A run whose energy is wrong by more than this share is wrong.
constexpr double most_energy_error = 0.1;

/// The limit of the final state is an estimate.
constexpr double surely_above_limit = 1.1;

/// True if the step is above the limit of the final state, and the balance does not show that the
/// run gained nothing: it is incomplete, or it closes only because dampers took what was gained.
bool is_doubtful(const RunPlan& plan, const EnergyShares& shares, double limit_at_end) {
  if (plan.adaptive || plan.dt <= surely_above_limit * limit_at_end ||
      plan.dt > plan.stability_limit)
    return false;
  return !shares.is_complete || !shares.is_resolved ||
         !(shares.gained() <= most_energy_error * shares.end);
}

bool is_wrong(const EnergyShares& shares) {
  if (!std::isfinite(shares.error)) return true;
  if (!shares.is_resolved) return false;
  return shares.error > most_energy_error ||
         (shares.is_complete && shares.error < -most_energy_error);
}

/// Judges on the root, which alone has the balance.
void judge_energy(const RunPlan& plan, RunResult& result) {
  if (!result.balance || result.status != "ok") return;
  const EnergyShares& shares = *result.balance;
  const double limit = result.stability_limit_end_s.value_or(plan.stability_limit);
  if (!is_wrong(shares) && !is_doubtful(plan, shares, limit)) return;
  result.status = "wrong";
  result.reason = fmt::format(
      "the energy of {:.4g} J at the end is {}: start {:.4g} J, work of loads {:.4g} J, dampers "
      "{}; "
      "take {}",
      shares.end,
      is_wrong(shares) ? fmt::format("wrong by {:+.2g} of it", shares.error) : "doubtful",
      shares.start, shares.work,
      shares.is_complete ? fmt::format("{:.4g} J", shares.dissipated) : "unknown",
      plan.adaptive ? "a smaller --rtol" : fmt::format("--dt below {:.6g} s", plan.dt));
  if (!plan.adaptive && plan.dt > limit)
    result.reason += fmt::format(" (the final state is stable up to {:.6g} s)", limit);
}

/// The verdict of the root, for all ranks.
bool is_ok_on_root(Executor& executor, const RunResult& result) {
  return gather(executor, result.status == "ok" ? 1.0 : 0.0).front() == 1;
}

} // namespace

RunResult run_scene(const RunRequest& request) {
  const RunPlan plan = plan_run(request);
  const Problem& problem = plan.scene.problem;
  flush_denormals();
  RunResult result = described(plan, request);
  TimedRun timed(plan, request, result);
  timed.run();
  result.model = name(timed.model());
  if (result.status != "ok") return result;
  const Rotation rotation = timed.equations();
  describe_end(timed, plan, result);
  judge_range(plan, rotation, result);
  if (result.status != "ok") return result;
  if (!request.state_csv.empty()) {
    const std::vector<double> state = whole_state(timed.executor(), problem.lattice.element_count);
    const WorkAlone alone(timed.executor(), request.is_root);
    if (request.is_root) write_state(request.state_csv, problem, state, rotation);
    result.files.push_back(request.state_csv);
  }
  result.wall_s += result.model_report.look_s;
  result.balance = timed.energy_balance();
  judge_check(result);
  judge_energy(plan, result);
  if (is_ok_on_root(timed.executor(), result))
    timed.take_samples(request.samples, request.repeat_for);
  return result;
}

} // namespace dss
