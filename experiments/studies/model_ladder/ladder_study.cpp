#include "experiments/studies/model_ladder/ladder_study.hpp"
#include "experiments/base/temporary_file.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/run/plan/exponential.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/state/oracle_state.hpp"
#include "experiments/run/state/restricted_oracle.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/run.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

const std::vector<std::string> ladder_columns = {"experiment",
                                                 "scene",
                                                 "set",
                                                 "precision",
                                                 "variant",
                                                 "elements",
                                                 "steps",
                                                 "model",
                                                 "wall_s",
                                                 "runs",
                                                 "error",
                                                 "tolerance",
                                                 "verdict",
                                                 "provable",
                                                 "why_not",
                                                 "ends_with",
                                                 "sufficient_smaller",
                                                 "promotions",
                                                 "monitor",
                                                 "rotation",
                                                 "status",
                                                 "reason"};

bool is_smaller(Model a, Model b) {
  return std::ranges::find(models, a) < std::ranges::find(models, b);
}

/// The rows of one scene.
class SceneLadder {
public:
  SceneLadder(const LadderStudy& study, const LadderScene& place)
      : study_(study), place_(place), scene_(load_scene(place.scene, place.set)),
        method_(require_stepwise(require_method(scene_.problem.integrator))),
        steps_(place.steps.value_or(scene_.problem.steps)), truth_("", ".oracle") {
    const double dt = scene_.problem.dt;
    const OracleState state = compute_oracle_state(scene_.problem, method_, Rotation::quaternion,
                                                   dt, steps_, place.scene);
    expected_ = state.state;
    write_oracle_state(truth_.path(), state);
  }

  std::vector<Record> rows() {
    std::vector<Record> rows;
    std::vector<Model> sufficient;
    for (const Model model : models) {
      rows.push_back(row_of(model));
      if (rows.back()["verdict"] == "sufficient") sufficient.push_back(model);
    }
    rows.push_back(row_of_auto(sufficient));
    return rows;
  }

private:
  double tolerance() const {
    const Problem& problem = scene_.problem;
    return (is_single(*find_precision(place_.precision)) ? problem.tolerance_f32
                                                         : problem.tolerance_f64)
        .run;
  }

  Record base(const std::string& model) const {
    return {{"experiment", study_.name},
            {"scene", scene_.name},
            {"set", set_text(place_.set)},
            {"precision", place_.precision},
            {"variant", study_.variant},
            {"elements", std::to_string(scene_.problem.lattice.element_count)},
            {"steps", std::to_string(steps_)},
            {"model", model},
            {"tolerance", number_text(tolerance())},
            {"status", "ok"}};
  }

  RunResult run(const std::string& model) const {
    RunRequest request;
    request.scene = place_.scene;
    request.overrides = place_.set;
    request.variant = study_.variant;
    request.model = model;
    request.precision = place_.precision;
    request.steps = steps_;
    request.check_state = truth_.path();
    request.check_tail = 0;
    request.repeat_for = study_.repeat_for;
    return run_scene(request);
  }

  static void add_times(const RunResult& result, Record& row) {
    row["variant"] = result.variant;
    row["wall_s"] = number_text(result.wall_s);
    row["runs"] = std::to_string(result.runs);
  }

  /// Runs the model on a variant if it has the scene's degrees of freedom. Otherwise the oracle
  /// runs it with the missing degrees of freedom held.
  double error_of(Model model, bool has_dofs, Record& row) const {
    try {
      if (has_dofs) {
        const RunResult result = run(std::string(name(model)));
        add_times(result, row);
        return result.check.is_done ? result.check.error : std::numeric_limits<double>::infinity();
      }
      row["variant"] = "oracle";
      return state_error(
          scene_.problem, expected_,
          restricted_state(scene_.problem, model, method_, scene_.problem.dt, steps_));
    } catch (const UnstableError& error) {
      row["reason"] = error.what();
      return std::numeric_limits<double>::infinity();
    }
  }

  Record row_of(Model model) const {
    Record row = base(std::string(name(model)));
    const std::string no_dofs = why_not(model, scene_.problem),
                      not_exact = why_not_exact(model, scene_.problem);
    const double error = error_of(model, no_dofs.empty(), row);
    const bool is_sufficient = error <= tolerance();
    row["error"] = number_text(error);
    row["verdict"] = is_sufficient ? "sufficient" : "insufficient";
    row["provable"] = not_exact.empty() ? "proven" : no_dofs.empty() ? "bounded" : "no";
    row["why_not"] = not_exact;
    if (not_exact.empty() && !is_sufficient) fail(row, "proven to suffice, and does not");
    if (is_sufficient && std::ranges::count(place_.fails, model) > 0)
      fail(row, "should fail, and does not");
    if (!is_sufficient && std::ranges::count(place_.suffices, model) > 0)
      fail(row, "should suffice, and does not");
    return row;
  }

  /// @param sufficient  models whose runs met the tolerance, provable or not
  Record row_of_auto(const std::vector<Model>& sufficient) const {
    Record row = base("auto");
    const RunResult result = run("auto");
    add_times(result, row);
    row["error"] = number_text(result.check.error);
    row["verdict"] = result.check.is_passed() ? "sufficient" : "insufficient";
    row["provable"] =
        result.model_choice.is_bounded && has_rotation_vectors(*find_model(result.model))
            ? "bounded"
            : "proven";
    row["ends_with"] = result.model;
    row["promotions"] = std::to_string(result.model_report.promotions.size());
    if (result.model_choice.is_bounded) {
      row["monitor"] = number_text(result.model_report.estimate);
      row["rotation"] = number_text(result.model_report.largest_rotation);
    }
    if (!result.check.is_passed() || !result.check.is_done)
      fail(row, "auto misses the tolerance: " + result.reason);
    if (result.model != name(place_.ends_with))
      fail(row,
           fmt::format("auto ends with {}, expected {}", result.model, name(place_.ends_with)));
    for (const Model model : sufficient)
      if (is_smaller(model, *find_model(result.model)))
        row["sufficient_smaller"] +=
            fmt::format("{}{}", row["sufficient_smaller"].empty() ? "" : " ", name(model));
    explain_smaller(result, row);
    return row;
  }

  /// Lists the reason against every smaller model, found before or during the run. A missing reason
  /// is a failure.
  void explain_smaller(const RunResult& result, Record& row) const {
    std::vector<std::string> words;
    for (const Model model : models) {
      if (!is_smaller(model, *find_model(result.model))) continue;
      const auto choice = std::ranges::find(result.model_choice.smaller, model,
                                            &std::pair<Model, std::string>::first);
      const auto promotion =
          std::ranges::find(result.model_report.promotions, model, &Promotion::from);
      if (choice != result.model_choice.smaller.end())
        words.push_back(fmt::format("{}: {}", name(model), choice->second));
      else if (promotion != result.model_report.promotions.end())
        words.push_back(fmt::format("{}: after step {} its error may be {:.3g}", name(model),
                                    promotion->step, promotion->estimate));
      else if (const std::string no_dofs = why_not(model, scene_.problem); !no_dofs.empty())
        words.push_back(fmt::format("{}: {}", name(model), no_dofs));
      else if (result.model_report.promotions.empty())
        fail(row, fmt::format("nothing says why {} would not do", name(model)));
      else
        words.push_back(fmt::format("{}: its bound fails where that of {} does", name(model),
                                    name(result.model_report.promotions.back().from)));
    }
    for (const std::string& word : words)
      row["why_not"] += (row["why_not"].empty() ? "" : "; ") + word;
  }

  static void fail(Record& row, const std::string& why) {
    row["status"] = "failed";
    row["reason"] += (row["reason"].empty() ? "" : "; ") + why;
  }

  const LadderStudy& study_;
  const LadderScene& place_;
  const Scene scene_;
  const Method& method_;
  const long steps_;
  TemporaryFile truth_;
  std::vector<double> expected_;
};

} // namespace

Table ladder_table(const LadderStudy& study, const std::function<void(const std::string&)>& note) {
  Table table{ladder_columns, {}};
  for (const LadderScene& scene : study.scenes) {
    note(fmt::format("{} {}", scene.scene, set_text(scene.set)));
    for (Record& row : SceneLadder(study, scene).rows()) table.rows.push_back(std::move(row));
  }
  return table;
}

std::string ladder_text(const LadderStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> cells;
  for (const Record& row : table.rows)
    cells.push_back({text_in(row, "scene"), text_in(row, "precision"), text_in(row, "model"),
                     text_in(row, "wall_s"), text_in(row, "error"), text_in(row, "tolerance"),
                     text_in(row, "verdict"), text_in(row, "provable"), text_in(row, "ends_with"),
                     text_in(row, "sufficient_smaller"), text_in(row, "status"),
                     text_in(row, "reason")});
  return fmt::format(
      "{}\n{}", study.title,
      text_table({"scene", "precision", "model", "wall [s]", "error", "tolerance", "verdict",
                  "provable", "ends with", "smaller would do", "status", "reason"},
                 cells));
}

} // namespace dss
