#include "experiments/run/timed/verdict.hpp"
#include "experiments/run/timed/breakdown.hpp"
#include "solver/error.hpp"
#include "solver/model/energy.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/numerics/stability_at_state.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

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

} // namespace

long energy_look_interval(std::size_t elements, long steps) {
  constexpr long most_looks = 16, most_looked_at = 2'000'000; // looks, and elements of all looks
  const long looks = std::clamp(most_looked_at / long(elements), 1L, most_looks);
  const long chunks = (steps + looks * signal_steps - 1) / (looks * signal_steps);
  return std::max(1L, chunks) * signal_steps;
}

Rotation equations_of(const RunPlan& plan, Model model) {
  return plan.rotation == Rotation::quaternion ? rotation_of(model) : plan.rotation;
}

bool has_energy_balance(const RunPlan& plan, const RunRequest& request, Rotation equations) {
  return request.has_balance && !plan.reference && equations != Rotation::small &&
         plan.scene.problem.lattice.element_count <= balanced_elements;
}

std::string breakdown_reason(const RunPlan& plan, const Outcome& outcome, long step) {
  return fmt::format("{}; take --dt below {:.6g} s",
                     breakdown_text(outcome.what, step, plan.dt, outcome.element),
                     plan.dt > plan.stability_limit ? plan.stability_limit : 0.5 * plan.dt);
}

void require_finite_start(const Problem& problem, Rotation rotation) {
  if (!std::isfinite(total_energy(problem, initial_state(problem), rotation)))
    throw InputError(fmt::format("{}: the energy at the start is beyond the range of numbers; give "
                                 "masses, lengths and velocities in SI units",
                                 problem.name));
}

bool is_balanced_by_steps(std::size_t elements, long steps) {
  constexpr double most_looked_at = 1.2e6; // some 1 us an element
  constexpr long most_steps = 20'000;      // some 10 us a look
  return steps <= most_steps && double(elements) * double(steps) <= most_looked_at;
}

void describe_executor(Executor& executor, const Plugin& plugin, RunResult& result) {
  result.schedule = executor.schedule();
  result.bytes = executor.bytes();
  result.workers = executor.workers();
  result.ranks = rank_info(executor);
  result.hybrid = hybrid_info(executor);
  result.device_use.device = device_use(executor).device;
  if (result.ranks.variant.empty()) return;
  result.variant = fmt::format("{}:{}", plugin.name, result.ranks.variant);
  result.isa = result.ranks.isa;
  result.has_fma = result.ranks.has_fma;
}

RunResult described(const RunPlan& plan, const RunRequest& request) {
  RunResult result;
  result.scene = plan.scene.name;
  result.variant = plan.plugin->name;
  result.isa = plan.plugin->isa;
  result.has_fma = plan.plugin->has_fma;
  result.model = name(plan.model);
  result.precision = name(plan.precision);
  result.integrator = plan.method->name;
  result.stages = plan.method->has_leaps() ? 0 : plan.method->stages;
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
  if (!plan.method->is_implicit() && !plan.method->has_leaps())
    result.evaluations = double(plan.steps) * plan.method->stages;
  return result;
}

void describe_state(const RunPlan& plan, Rotation rotation, const std::vector<double>& state,
                    RunResult& result) {
  const Problem& problem = plan.scene.problem;
  const auto [energy_j, reactions] =
      energy_and_reactions(problem, state, rotation, signals_at(problem, result.end_s));
  result.energy_j = energy_j;
  result.reactions = reactions;
  if (result.model_report.promotions.empty())
    result.energy_drift = energy_drift(problem, rotation, result.energy_j);
  if (problem.lattice.element_count <= stability_state_elements && !plan.adaptive &&
      !plan.method->is_unlimited())
    result.stability_limit_end_s = limit_of_end(plan, rotation, state);
}

void judge_range(const RunPlan& plan, Rotation rotation, RunResult& result) {
  if (std::isfinite(result.max_displacement_m) && std::isfinite(result.energy_j.value_or(0)))
    return;
  const Problem& problem = plan.scene.problem;
  require_finite_start(problem, rotation);
  result.status = "unstable";
  result.reason = fmt::format("{}: displacements or energy at the end are beyond the range of "
                              "numbers; take --dt below {:.6g} s",
                              problem.name, 0.5 * plan.dt);
}

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

} // namespace dss
