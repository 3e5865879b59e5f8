#include "experiments/run/timed/run.hpp"
#include "experiments/run/checkpoint/checkpoint_plan.hpp"
#include "experiments/run/guard/guard.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/output.hpp"
#include "experiments/run/timed/timed_run.hpp"
#include "experiments/run/timed/verdict.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/isa/denormals.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

/// Finds what the final state says of the run.
void describe_end(TimedRun& timed, const RunPlan& plan, RunResult& result) {
  const std::size_t count = plan.scene.problem.lattice.element_count;
  result.max_displacement_m = max_displacement(timed.executor(), count);
  result.digest = state_digest(timed.executor(), count, plan.precision);
  if (count > energy_elements) return;
  describe_state(plan, timed.equations(), whole_state(timed.executor(), count), result);
}

/// The verdict of the root, for all ranks.
bool is_ok_on_root(Executor& executor, const RunResult& result) {
  return gather(executor, result.status == "ok" ? 1.0 : 0.0).front() == 1;
}

} // namespace

RunResult run_scene(const RunRequest& request, FileSet& outputs) {
  const RunPlan plan = plan_run(request);
  require_sound_checkpoints(request, plan);
  require_sound_guard(request, plan);
  const Problem& problem = plan.scene.problem;
  flush_denormals();
  RunResult result = described(plan, request);
  TimedRun timed(plan, request, outputs, result);
  timed.run();
  result.model = name(timed.model());
  if (result.status != "ok") return result;
  const Rotation rotation = timed.equations();
  describe_end(timed, plan, result);
  judge_range(plan, rotation, result);
  if (result.status != "ok") return result;
  if (const std::vector<std::string> files = final_files(request); !files.empty()) {
    const std::vector<double> state = whole_state(timed.executor(), problem.lattice.element_count);
    const WorkAlone alone(timed.executor(), request.is_root);
    if (request.is_root)
      write_final_files(outputs, request, problem, state, rotation,
                        signals_at(problem, result.end_s));
    result.files.insert(result.files.end(), files.begin(), files.end());
  }
  result.wall_s += result.model_report.look_s;
  result.balance = timed.energy_balance();
  judge_check(result);
  judge_energy(plan, result);
  if (is_ok_on_root(timed.executor(), result))
    timed.take_samples(request.samples, request.repeat_for);
  return result;
}

RunResult run_scene(const RunRequest& request) {
  FileSet outputs;
  RunResult result = run_scene(request, outputs);
  outputs.commit();
  return result;
}

} // namespace dss
