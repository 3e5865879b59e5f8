#include "experiments/studies/error_budget/error_budget.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/run/plan/exponential.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/state/accuracy.hpp"
#include "experiments/run/state/refinement.hpp"
#include "experiments/run/state/run_states.hpp"
#include "solver/numerics/stability.hpp"

#include <cmath>
#include <map>

namespace dss {
namespace {

using States = std::vector<std::vector<double>>;

/// Solutions by scene, overrides and times; budgets of the same scene share them.
using Solutions = std::map<std::string, Solution>;

/// Computes the errors of one scene.
class SceneBudget {
public:
  SceneBudget(const ErrorBudgetStudy& study, const BudgetScene& budget, Solutions& solutions,
              const std::function<void(const std::string&)>& note)
      : study_(study), budget_(budget), solutions_(solutions), note_(note),
        scene_(load_scene(budget.scene, budget.set)),
        method_(require_stepwise(require_method(budget.integrator))) {}

  std::vector<Record> rows() {
    const bool is_small = scene_.problem.lattice.element_count <= sharp_stability_elements;
    const double largest = fitting_step(stable_step(scene_.problem, method_, is_small).dt);
    add("time", budget_.dt, [&](Record& row) { against_solution(budget_.dt, row); });
    add("time at the stability limit", largest,
        [&](Record& row) { against_solution(largest, row); });
    if (!budget_.refinement.empty())
      add("space", budget_.dt, [&](Record& row) { over_grids(row); });
    for (const std::string& precision : budget_.precisions)
      add("rounding " + precision, budget_.dt,
          [&](Record& row) { against_long_double(precision, row); });
    for (const std::string& model : budget_.models)
      add("model " + model, budget_.dt, [&](Record& row) {
        RunRequest other = request(budget_.dt);
        other.model = model;
        against(plain(), run_states(other, budget_.times), row);
      });
    for (const std::string& rotation : budget_.rotations)
      add("rotation " + rotation, budget_.dt, [&](Record& row) {
        RunRequest usual = request(budget_.dt), other = request(budget_.dt);
        usual.variant = other.variant = "reference"; // only this variant has other rotations
        other.rotation = rotation;
        against(run_states(usual, budget_.times), run_states(other, budget_.times), row);
      });
    return std::move(rows_);
  }

private:
  /// Adds a row. If `fill` throws, the row keeps the reason.
  template <class Fill>
  void add(const std::string& source, double dt, const Fill& fill) {
    if (note_) note_(fmt::format("{}: {}", budget_.label, source));
    Record row = {{"experiment", study_.name},
                  {"scale", study_.scale},
                  {"label", budget_.label},
                  {"scene", budget_.scene},
                  {"set", set_text(budget_.set)},
                  {"elements", fmt::format("{}", scene_.problem.lattice.element_count)},
                  {"integrator", budget_.integrator},
                  {"dt_s", number_text(dt)},
                  {"end_time_s", number_text(budget_.times.end)},
                  {"saved_times", fmt::format("{}", budget_.times.count)},
                  {"source", source},
                  {"status", "ok"}};
    try {
      fill(row);
    } catch (const UnstableError& error) {
      row["status"] = "unstable";
      row["reason"] = error.what();
    } catch (const std::exception& error) {
      row["status"] = "failed";
      row["reason"] = error.what();
    }
    rows_.push_back(row);
  }

  RunRequest request(double dt) const {
    RunRequest run;
    run.scene = budget_.scene;
    run.overrides = budget_.set;
    run.variant = budget_.variant;
    run.integrator = budget_.integrator;
    run.dt = dt;
    return run;
  }

  /// The largest step, at most `limit` [s], that divides the time between saved times.
  double fitting_step(double limit) const {
    return budget_.times.interval() /
           double(budget_.times.steps_between(std::min(limit, budget_.times.interval())));
  }

  const States& plain() {
    if (plain_.empty()) plain_ = run_states(request(budget_.dt), budget_.times);
    return plain_;
  }

  void against(const States& expected, const States& actual, Record& row) const {
    const Accuracy accuracy = accuracy_of(scene_.problem, expected, actual);
    row["error"] = number_text(accuracy.max);
    row["error_final"] = number_text(accuracy.final);
  }

  void against_solution(double dt, Record& row) {
    const std::string key = fmt::format("{} {} {:.17g} {}", budget_.scene, set_text(budget_.set),
                                        budget_.times.end, budget_.times.count);
    if (!solutions_.contains(key))
      solutions_[key] = find_solution(scene_.problem,
                                      require_stepwise(require_method(study_.solution.integrator)),
                                      study_.solution, budget_.times, note_);
    const Solution& solution = solutions_[key];
    row["reference_error"] = number_text(solution.error);
    against(solution.states, dt == budget_.dt ? plain() : run_states(request(dt), budget_.times),
            row);
  }

  void against_long_double(const std::string& precision, Record& row) {
    if (long_double_.empty())
      long_double_ = oracle_states(scene_.problem, method_, budget_.times,
                                   budget_.times.whole_steps_between(budget_.dt));
    RunRequest run = request(budget_.dt);
    run.precision = precision;
    against(long_double_, run_states(run, budget_.times), row);
  }

  /// Mean displacement [m] of the first load's elements on a grid, at the saved times. The step
  /// shrinks with the elements' edges, or more if the stability limit of the grid requires it.
  History on_grid(std::size_t level) const {
    RunRequest run = request(budget_.dt);
    run.overrides.insert(run.overrides.end(), budget_.refinement[level].begin(),
                         budget_.refinement[level].end());
    const Scene scene = load_scene(run.scene, run.overrides);
    const double of_grid = stable_step(scene.problem, method_).dt; // a lower bound, which is cheap
    run.dt = fitting_step(std::min(budget_.dt / std::pow(budget_.ratio, double(level)), of_grid));
    const std::vector<std::size_t>& loaded = scene.problem.loads.front().elements;
    History history;
    for (const std::vector<double>& state : run_states(run, budget_.times)) {
      Vec3 mean{};
      for (const std::size_t element : loaded)
        for (std::size_t axis = 0; axis < 3; ++axis)
          mean[axis] += state[element * field_count + ux + axis] / double(loaded.size());
      history.push_back(mean);
    }
    return history;
  }

  void over_grids(Record& row) const {
    const std::array<History, 3> grids = {on_grid(0), on_grid(1), on_grid(2)};
    const Extrapolation limit = extrapolate(grids, budget_.ratio, budget_.is_one_body);
    row["error"] = number_text(limit.error);
    row["error_final"] = number_text(limit.error_final);
    row["refined"] = budget_.refined;
    if (limit.converges) {
      row["observed_order"] = number_text(limit.order);
      row["extrapolated_m"] = number_text(limit.value);
      return;
    }
    row["status"] = "no limit";
    row["reason"] = fmt::format("{}: the error is the difference between the first and the last",
                                budget_.is_one_body ? "differences grow from grid to grid"
                                                    : "each grid is another body");
  }

  const ErrorBudgetStudy& study_;
  const BudgetScene& budget_;
  Solutions& solutions_;
  const std::function<void(const std::string&)>& note_;
  Scene scene_;
  const Method& method_;
  std::vector<Record> rows_;
  States plain_, long_double_;
};

} // namespace

Table error_budget_table(const ErrorBudgetStudy& study,
                         const std::function<void(const std::string&)>& note) {
  Table table{{"experiment", "scale", "label", "scene", "set", "elements", "integrator", "dt_s",
               "end_time_s", "saved_times", "source", "error", "error_final", "observed_order",
               "extrapolated_m", "refined", "reference_error", "status", "reason"},
              {}};
  Solutions solutions;
  for (const BudgetScene& budget : study.scenes)
    for (const Record& row : SceneBudget(study, budget, solutions, note).rows())
      table.rows.push_back(row);
  return table;
}

} // namespace dss
