#include "experiments/base/clock.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/samples.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/studies/mixed_nodes/mixed_study.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/cost/trial.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr int timings = 8; ///< the best of them counts, on both sides
/// Simulated and measured steps differ if the whole interval of their ratios is farther from 1.
constexpr double held_within = 0.1;

/// Best time of a step [s] of a run of one process.
double run_step_s(const SimulatedProblem& what) {
  const auto executor = load_variant("auto").create(
      {what.problem, what.method, what.model, what.precision, what.problem.dt});
  write_initial_state(*executor, what.problem);
  const auto timed_s = [&](long steps) {
    const std::vector<double> signals =
        signal_rows(what.problem, what.method, what.problem.dt, 0, steps);
    const auto start = Clock::now();
    executor->advance(steps, signals);
    return seconds_since(start);
  };
  const long steps = trial_steps(timed_s);
  double best = timed_s(steps);
  for (int n = 1; n < timings; ++n) best = std::min(best, timed_s(steps));
  return best / double(steps);
}

/// The simulated time of that step, from a speed that is measured now.
double simulated_step_s(const SimulatedProblem& what, const Decomposition& whole,
                        const Platform& platform) {
  const NodeSpeed speed =
      measure_speed({what.problem, what.method, what.model, what.precision, what.problem.dt},
                    load_variant("auto"), whole, 0, timings);
  return simulate(make_plan(what, whole, {&speed, 1}, "deep", mixed_simulated_steps),
                  platform.path())
      .step_s;
}

Record held_row(const MixedStudy& study, const std::vector<Override>& set) {
  const Scene scene = load_scene(study.scene, set);
  const SimulatedProblem what = simulated_problem(scene);
  const Decomposition whole = decompose(scene.problem, "strips", 1);
  const Platform platform("fdr"); // any network: one process sends nothing
  std::vector<double> ratios;
  for (long pair = 0; pair < study.pairs; ++pair) {
    double run = 0, simulated = 0;
    const auto time_run = [&] { run = run_step_s(what); };
    const auto time_simulated = [&] { simulated = simulated_step_s(what, whole, platform); };
    if (pair % 2 == 0)
      time_run(), time_simulated();
    else
      time_simulated(), time_run();
    ratios.push_back(simulated / run);
  }
  Record row = {{"experiment", study.name},
                {"scene", scene.name},
                {"set", set_text(set)},
                {"elements", fmt::format("{}", scene.problem.lattice.element_count)},
                {"variant", load_variant("auto").name},
                {"pairs", fmt::format("{}", study.pairs)}};
  const Estimate found = estimate(ratios);
  put_interval(row, "simulated_over_run", found);
  const bool is_outside = found.interval && (found.interval->low > 1 + held_within ||
                                             found.interval->high < 1 / (1 + held_within));
  row["status"] = is_outside ? "differs" : "ok";
  if (is_outside)
    row["reason"] =
        fmt::format("simulated and measured steps differ by more than {:g} %", 100 * held_within);
  return row;
}

} // namespace

Table held_table(const MixedStudy& study, Progress& progress) {
  Table table{{"experiment", "scene", "set", "elements", "variant", "pairs", "simulated_over_run",
               "simulated_over_run_low", "simulated_over_run_high", "status", "reason"},
              {}};
  if (const std::string why = why_no_simulation(); !why.empty()) {
    table.rows.push_back({{"experiment", study.name}, {"status", "skipped"}, {"reason", why}});
    return table;
  }
  for (const auto& set : study.held_sets) {
    progress.note(fmt::format("simulator against runs: {} {}", study.scene, set_text(set)));
    table.rows.push_back(held_row(study, set));
  }
  return table;
}

} // namespace dss
