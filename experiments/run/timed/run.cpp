#include "experiments/run/timed/run.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/output.hpp"
#include "experiments/run/timed/timed_run.hpp"
#include "solver/model/energy.hpp"
#include "variants/isa/denormals.hpp"

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

void judge(const CheckResult& check, RunResult& result) {
  if (!check.is_done || check.is_passed()) return;
  result.status = "wrong";
  result.reason = check.tail_error && !(*check.tail_error <= check.tolerance)
                      ? fmt::format("error {:.3g} over the last steps exceeds the tolerance {:.3g}",
                                    *check.tail_error, check.tolerance)
                      : fmt::format("error {:.3g} ({}) exceeds the tolerance {:.3g}", check.error,
                                    check.how, check.tolerance);
}

} // namespace

RunResult run_scene(const RunRequest& request) {
  const RunPlan plan = plan_run(request);
  const Problem& problem = plan.scene.problem;
  const std::size_t count = problem.lattice.element_count;
  flush_denormals();
  RunResult result = described(plan, request);
  TimedRun timed(plan, request, result);
  timed.run();
  result.model = name(timed.model());
  if (result.status != "ok") return result;
  const Rotation rotation = timed.equations();
  result.max_displacement_m = max_displacement(timed.executor(), count);
  result.digest = state_digest(timed.executor(), count, plan.precision);
  if (count <= energy_elements)
    result.energy_j = total_energy(problem, whole_state(timed.executor(), count), rotation);
  if (result.model_report.promotions.empty())
    result.energy_drift = energy_drift(problem, rotation, result.energy_j);
  if (!request.state_csv.empty()) {
    const std::vector<double> state = whole_state(timed.executor(), count);
    const WorkAlone alone(timed.executor(), request.is_root);
    if (request.is_root) write_state(request.state_csv, problem, state, rotation);
    result.files.push_back(request.state_csv);
  }
  result.wall_s += result.model_report.look_s;
  judge(result.check, result);
  if (result.status == "ok") timed.repeat(request.repeat_for);
  return result;
}

} // namespace dss
