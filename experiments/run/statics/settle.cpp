#include "experiments/run/statics/settle.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/breakdown.hpp"
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/stability.hpp"
#include "variants/isa/denormals.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

/// Time between checks of the unbalanced forces, in units of 1 / omega of the lowest mode.
constexpr double times_between = 4;
constexpr int most_looks = 40;
constexpr double accepted = 1e-8; ///< unbalanced forces at which rounding may stop further progress
constexpr long batch_steps = 256;

/// Adds viscous ties that damp a mode of frequency omega critically; other modes decay at the same
/// rate.
void damp(Problem& problem, double omega) {
  double mass = 0, inertia = 0;
  for (const Body& body : problem.bodies) {
    const double ratio = body.mass_ratios.empty() ? 1 : std::ranges::max(body.mass_ratios);
    mass = std::max(mass, ratio * body.mass);
    inertia = std::max(inertia, ratio * std::ranges::min(body.inertia));
  }
  problem.stabilization.d += 2 * omega * mass;
  problem.stabilization.d_rot += 2 * omega * inertia;
}

void advance(Executor& executor, const Problem& problem, const Method& method, double dt, long step,
             long steps) {
  for (long done = 0; done < steps; done += batch_steps) {
    const long count = std::min(batch_steps, steps - done);
    const Outcome outcome =
        executor.advance(count, signal_rows(problem, method, dt, step + done, count));
    if (!outcome.is_finite)
      throw UnstableError(fmt::format(
          "{}: {}", problem.name,
          breakdown_text(outcome.what, step + done + outcome.step, dt, outcome.element)));
  }
}

} // namespace

AnalysisResult settle(const RunRequest& run, const AnalysisRequest& request) {
  RunRequest asked = run;
  asked.is_forced = true; // the scene's step is not used
  asked.integrator = run.integrator.value_or("velocity_verlet");
  const RunPlan plan = plan_run(asked);
  const std::uint8_t dofs = why_not_planar(plan.scene.problem).empty() ? degrees_of(Model::planar)
                                                                       : degrees_of(plan.model);
  StaticSystem system(plan.scene.problem, rotation_of(plan.model), dofs, request.loads);
  Problem problem = held_still(plan.scene.problem, request.loads);
  problem.initial_motions.clear();
  AnalysisResult result;
  const auto start = Clock::now();
  const std::vector<NaturalMode> modes = find_modes(system, 1, system.rest(), true).modes;
  if (modes.empty())
    throw InputError(fmt::format("{}: has no mode with a frequency, by which it could be damped",
                                 plan.scene.name));
  const double omega = modes.front().omega;
  damp(problem, omega);
  const Method method = fitted(problem, *plan.method, plan.dt);
  result.dt_s = 0.95 * stable_step(problem, method).dt;
  flush_denormals();
  const auto executor =
      plan.plugin->create({problem, method, plan.model, plan.precision, result.dt_s, run.threads,
                           nullptr, &plan.distribution, run.device, run.hybrid, plan.rotation});
  write_initial_state(*executor, problem);
  const long steps = std::max(1L, std::lround(times_between / (omega * result.dt_s)));
  double last = std::numeric_limits<double>::infinity();
  for (bool is_settled = false; !is_settled && result.iterations < most_looks;
       ++result.iterations) {
    advance(*executor, problem, method, result.dt_s, result.steps, steps);
    result.steps += steps;
    result.state = whole_state(*executor, problem.lattice.element_count);
    result.residual = system.residual(system.inside(result.state));
    const bool is_held_by_rounding = result.residual <= accepted && result.residual > 0.5 * last;
    is_settled = result.residual <= request.tolerance || is_held_by_rounding;
    last = result.residual;
  }
  result.wall_s = seconds_since(start);
  result.analysis = "static";
  result.solver = "settled";
  result.scene = plan.scene.name;
  result.model = name(plan.model);
  result.variant = plan.plugin->name;
  result.precision = name(plan.precision);
  result.integrator = method.name;
  result.elements = problem.lattice.element_count;
  result.unknowns = long(system.size());
  if (!(result.residual <= accepted)) {
    result.status = "not converged";
    result.reason = fmt::format("unbalanced forces are {:.2g} of the loads after {} steps",
                                result.residual, result.steps);
  }
  return result;
}

} // namespace dss
