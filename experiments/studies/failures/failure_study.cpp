#include "experiments/studies/failures/failure_study.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/studies/failures/atlas_run.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/numerics/stability.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dss {
namespace {

const std::vector<std::string> failure_columns = {
    "experiment", "case",    "scene",    "set",   "method", "precision", "rotation",
    "model",      "variant", "dt_s",     "steps", "metric", "figure",    "predicted",
    "deviation",  "verdict", "expected", "why",   "status", "reason"};

constexpr double far = 1e300; ///< formulas get this number instead of infinity

bool holds(const std::vector<std::string>& names, std::string_view one) {
  return names.empty() || std::ranges::find(names, one) != names.end();
}

/// All cells of one case with one set of overrides.
class CaseRun {
public:
  CaseRun(const FailureStudy& study, const FailureCase& atlas, const std::vector<Override>& set)
      : study_(study), atlas_(atlas), set_(set), scene_(load_scene(atlas.scene, set)),
        plugin_(load_variant(atlas.variant)), references_(atlas.reference, scene_, set_) {}

  void run(std::vector<Record>& rows) {
    for (const std::string& method : atlas_.methods)
      for (const std::string& precision : atlas_.precisions)
        for (const std::string& rotation : atlas_.rotations)
          for (const Formula& dt : atlas_.dt)
            rows.push_back(row(*find_method(method), *find_precision(precision),
                               *find_rotation(rotation), dt));
  }

private:
  const Expectation* expectation(const Method& method, Precision precision,
                                 Rotation rotation) const {
    const Expectation* found = nullptr;
    for (const Expectation& one : atlas_.expectations) {
      const bool is_of_set = std::ranges::all_of(one.set, [&](const Override& wanted) {
        return std::ranges::any_of(set_, [&](const Override& own) {
          return own.key == wanted.key && own.value == wanted.value;
        });
      });
      if (is_of_set && holds(one.methods, method.name) && holds(one.precisions, name(precision)) &&
          holds(one.rotations, name(rotation)))
        found = &one;
    }
    return found;
  }

  /// Largest stable step of the scene [s], computed once per method.
  double limit_of(const Method& method) {
    if (method.is_implicit()) return far;
    const auto [known, is_new] = limits_.try_emplace(&method, 0);
    if (is_new) known->second = std::min(far, stable_step(scene_.problem, method, true).dt);
    return known->second;
  }

  /// Names that formulas of the case may use: the scene's parameters and some numbers of the cell.
  Parameters cell_parameters(const Method& method, Precision precision) {
    Parameters parameters = scene_.parameters;
    parameters["order"] = method.order;
    parameters["stages"] = method.stages;
    parameters["eps"] = precision == Precision::f64 ? 0x1p-53 : 0x1p-24;
    if (atlas_.names_limit) parameters["limit"] = limit_of(method);
    if (!atlas_.omega.is_present()) return parameters;
    parameters["omega"] = atlas_.omega(parameters);
    parameters["rate"] = atlas_.rate(parameters);
    parameters["mode_limit"] =
        method.is_implicit()
            ? far
            : std::min(far, mode_step_limit(method, parameters["omega"], parameters["rate"]));
    return parameters;
  }

  /// Reason why the program would refuse to run the cell, or empty. The rules are those of
  /// plan_run, but methods are not fitted to the step.
  std::string refusal(const Method& method, Precision precision, Rotation rotation, Model model,
                      double dt) {
    if (const auto lack = what_lacks(plugin_, scene_.problem, precision, method, rotation))
      return fmt::format("variant {} {}", plugin_.name, lack->what);
    if (const std::string why = why_not(model, scene_.problem); !why.empty())
      return fmt::format("model {}: {}", name(model), why);
    if (dt == 0) return fmt::format("no step of {} is stable here", method.name);
    if (atlas_.is_forced || method.is_implicit()) return {};
    if (dt > limit_of(method))
      return fmt::format("dt = {:.6g} s is above the stability limit {:.6g} s", dt,
                         limit_of(method));
    return {};
  }

  std::string verdict(const AtlasFigure& figure, const Parameters& parameters) const {
    const double size = std::abs(figure.value);
    if (!std::isfinite(size) ||
        (atlas_.unstable_above.is_present() && size > atlas_.unstable_above(parameters)))
      return "unstable";
    const bool is_below = !atlas_.ok_below.is_present() || size < atlas_.ok_below(parameters);
    const bool is_enough =
        !atlas_.ok_at_least.is_present() || figure.value >= atlas_.ok_at_least(parameters);
    return is_below && is_enough ? "ok" : atlas_.otherwise;
  }

  /// Number of steps, and the step that reaches the end of the case exactly. Both are 0 if the step
  /// is a fraction of a limit that is 0.
  std::pair<long, double> steps_of(Parameters& parameters, const Formula& asked) const {
    double dt = asked(parameters);
    const auto is_zero = [&](const char* limit) {
      return parameters.contains(limit) && parameters.at(limit) == 0;
    };
    if (dt == 0 && (is_zero("limit") || is_zero("mode_limit"))) return {0, 0};
    const double count = atlas_.steps.is_present() ? atlas_.steps(parameters)
                                                   : std::ceil(atlas_.end(parameters) / dt - 1e-9);
    if (!(dt > 0) || !(count >= 1 && count <= 1e9))
      throw InputError(
          fmt::format("{}: case {}: {:g} steps of {:g} s; give 1 to 1e9 of a positive step",
                      study_.path, atlas_.name, count, dt));
    const long steps = std::lround(count);
    if (atlas_.end.is_present()) dt = atlas_.end(parameters) / double(steps);
    parameters["dt"] = dt;
    parameters["steps"] = double(steps);
    parameters["end"] = dt * double(steps);
    return {steps, dt};
  }

  /// Compares a figure with the expectation and fills the last of the failure_columns.
  void judge(Record& row, const Expectation* expected, const AtlasFigure& figure,
             const Parameters& parameters) const {
    std::string reason = row["reason"];
    bool passes = expected != nullptr && expected->verdict == row["verdict"];
    const auto add = [&](const std::string& text) {
      reason += (reason.empty() ? "" : "; ") + text;
    };
    if (expected == nullptr) {
      add("no expectation fits this cell");
    } else {
      row["expected"] = expected->verdict;
      row["why"] = expected->why;
      if (!passes) add(fmt::format("expected {}", expected->verdict));
      if (expected->predicted.is_present() && std::isfinite(figure.value)) {
        const double predicted = expected->predicted(parameters),
                     deviation = figure.value / predicted - 1;
        row["predicted"] = number_text(predicted);
        row["deviation"] = number_text(deviation);
        if (!(std::abs(deviation) <= expected->within)) {
          passes = false;
          add(fmt::format("{:.2g} from the prediction, {:g} is allowed", deviation,
                          expected->within));
        }
      }
    }
    row["status"] = passes ? "passed" : "failed";
    row["reason"] = reason;
  }

  Record row(const Method& method, Precision precision, Rotation rotation, const Formula& asked) {
    Parameters parameters = cell_parameters(method, precision);
    const auto [steps, dt] = steps_of(parameters, asked);
    const Model model = *find_model(atlas_.model.empty() ? scene_.model : atlas_.model);
    Record row = {{"experiment", study_.name},
                  {"case", atlas_.name},
                  {"scene", scene_.name},
                  {"set", set_text(set_)},
                  {"method", std::string(method.name)},
                  {"precision", std::string(name(precision))},
                  {"rotation", std::string(name(rotation))},
                  {"model", std::string(name(model))},
                  {"variant", plugin_.name},
                  {"dt_s", number_text(dt)},
                  {"steps", fmt::format("{}", steps)},
                  {"metric", atlas_.metric}};
    AtlasFigure figure{std::numeric_limits<double>::quiet_NaN()};
    row["reason"] = refusal(method, precision, rotation, model, dt);
    try {
      if (row["reason"].empty()) {
        figure = measured_figure(
            {atlas_, scene_, plugin_, method, precision, rotation, model, dt, steps}, parameters,
            references_);
        row["figure"] = std::isfinite(figure.value) ? number_text(figure.value) : "";
        row["verdict"] = verdict(figure, parameters);
        row["reason"] = figure.breakdown;
      } else {
        row["verdict"] = "refused";
      }
    } catch (const std::exception& error) { // the other cells continue
      row["reason"] = error.what();
    }
    judge(row, expectation(method, precision, rotation), figure, parameters);
    return row;
  }

  const FailureStudy& study_;
  const FailureCase& atlas_;
  const std::vector<Override>& set_;
  Scene scene_;
  const Plugin& plugin_;
  AtlasReferences references_;
  std::map<const Method*, double> limits_;
};

} // namespace

Table failures_table(const FailureStudy& study) {
  Table table{failure_columns, {}};
  for (const FailureCase& atlas : study.cases)
    for (const std::vector<Override>& set : atlas.sets) CaseRun(study, atlas, set).run(table.rows);
  return table;
}

std::string failures_text(const FailureStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  std::size_t failed = 0;
  for (const Record& row : table.rows) {
    const double figure = number_in(row, "figure");
    failed += text_in(row, "status") == "failed";
    rows.push_back({text_in(row, "case"), text_in(row, "set"), text_in(row, "method"),
                    text_in(row, "precision"), text_in(row, "rotation"),
                    std::isnan(figure) ? "" : fmt::format("{:.3g}", figure),
                    text_in(row, "verdict"),
                    text_in(row, "status") == "failed" ? "FAILED: " + text_in(row, "reason") : ""});
  }
  return fmt::format(
      "{} ({})\n{}{} cells, {} with another verdict or figure than theory says", study.title,
      study.name,
      text_table({"case", "set", "method", "precision", "rotation", "figure", "verdict", ""}, rows),
      rows.size(), failed);
}

} // namespace dss
