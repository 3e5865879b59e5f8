#include "experiments/run/state/run_states.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/breakdown.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/isa/denormals.hpp"
#include "variants/leaps/leap_executor.hpp"

namespace dss {

std::vector<std::vector<double>> run_states(RunRequest request, const SavedTimes& times) {
  const double dt =
      request.dt ? *request.dt : load_scene(request.scene, request.overrides).problem.dt;
  const long between = times.whole_steps_between(dt);
  request.steps = between * times.count;
  const RunPlan plan = plan_run(request);
  const Problem& problem = plan.scene.problem;
  const FlushDenormals flush;
  const auto executor = make_executor(
      *plan.plugin, {problem, *plan.method, plan.model, plan.precision, plan.dt, request.threads,
                     nullptr, &plan.distribution, request.device, request.hybrid, plan.rotation});
  write_initial_state(*executor, problem);
  std::vector<std::vector<double>> states;
  for (long step = 0; step < plan.steps; step += between) {
    const Outcome outcome =
        executor->advance(between, signal_rows(problem, *plan.method, plan.dt, step, between));
    if (!outcome.is_finite)
      throw UnstableError(
          fmt::format("{}: {}", problem.name,
                      breakdown_text(outcome.what, step + outcome.step, plan.dt, outcome.element)));
    states.push_back(whole_state(*executor, problem.lattice.element_count));
  }
  return states;
}

} // namespace dss
