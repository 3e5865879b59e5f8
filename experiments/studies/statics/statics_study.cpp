#include "experiments/studies/statics/statics_study.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/run/statics/settle.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace dss {
namespace {

const std::vector<std::string> statics_columns = {
    "experiment", "scene",    "set",           "loads",     "elements", "unknowns",
    "solver",     "model",    "variant",       "precision", "wall_s",   "runs",
    "iterations", "matrices", "cg_iterations", "steps",     "residual", "max_displacement_m",
    "difference", "bar",      "status",        "reason",    "note"};

/// A shorter solution is timed 3 times; the shortest time counts.
constexpr double long_enough_s = 0.2;
constexpr int short_runs = 3;

/// A way to find a static equilibrium.
struct Way {
  std::string label;
  bool is_linear = false;
  std::function<AnalysisResult(const RunRequest&, AnalysisRequest)> solve;
};

std::vector<Way> ways_of(const StaticsCase& one) {
  const auto by = [](std::string label, bool is_linear, const std::string& solver,
                     const std::string& preconditioner, const std::string& masses) {
    return Way{std::move(label), is_linear, [=](const RunRequest& run, AnalysisRequest request) {
                 request.solver = solver;
                 request.preconditioner = preconditioner;
                 request.masses = masses;
                 return solve_static(run, request);
               }};
  };
  std::vector<Way> ways = {
      by("newton", false, "newton", "incomplete_cholesky", "scaled"),
      by("direct", true, "direct", "incomplete_cholesky", "scaled"),
      by("cg, incomplete Cholesky", true, "cg", "incomplete_cholesky", "scaled"),
      by("cg, block Jacobi", true, "cg", "block_jacobi", "scaled"),
      by("relaxation, scaled masses", false, "relaxation", "incomplete_cholesky", "scaled"),
  };
  if (one.settles) {
    ways.push_back(
        by("relaxation, scene's masses", false, "relaxation", "incomplete_cholesky", "scene"));
    ways.push_back({"damped run", false, settle});
  }
  return ways;
}

/// The first result, with the shortest time of all runs.
AnalysisResult timed(const Way& way, const RunRequest& run, const AnalysisRequest& request,
                     int& runs) {
  AnalysisResult result = way.solve(run, request);
  for (runs = 1; runs < short_runs && result.wall_s < long_enough_s; ++runs)
    result.wall_s = std::min(result.wall_s, way.solve(run, request).wall_s);
  return result;
}

void fill(const AnalysisResult& result, Record& row) {
  row["elements"] = fmt::format("{}", result.elements);
  row["unknowns"] = fmt::format("{}", result.unknowns);
  row["model"] = result.model;
  row["variant"] = result.variant;
  row["precision"] = result.variant.empty() ? "f64" : result.precision;
  row["wall_s"] = number_text(result.wall_s);
  row["iterations"] = fmt::format("{}", result.iterations);
  if (result.variant.empty()) {
    row["matrices"] = fmt::format("{}", result.matrices);
    row["cg_iterations"] = fmt::format("{}", result.cg_iterations);
  } else {
    row["steps"] = fmt::format("{}", result.steps);
  }
  row["residual"] = number_text(result.residual);
  row["max_displacement_m"] = number_text(result.max_displacement_m);
  row["note"] = result.note;
}

void judge(const StaticsStudy& study, const Way& way, double loads, const AnalysisResult& result,
           Record& row) {
  row["bar"] = number_text(study.bar);
  const double difference = number_in(row, "difference");
  if (result.status != "ok") {
    row["status"] = "failed";
    row["reason"] = result.reason;
  } else if (way.is_linear && loads == 1) {
    row["status"] = "linear";
    row["bar"].clear();
  } else {
    row["status"] = difference <= study.bar ? "passed" : "failed";
    if (difference > study.bar)
      row["reason"] = fmt::format("{:.2g} from Newton's state", difference);
  }
}

void add_rows(const StaticsStudy& study, const StaticsCase& one, double loads, Table& table) {
  RunRequest run;
  run.scene = one.scene;
  run.overrides = one.set;
  run.variant = study.variant;
  AnalysisRequest request;
  request.loads = loads;
  std::vector<double> newton;
  for (const Way& way : ways_of(one)) {
    Record row = {{"experiment", study.name},
                  {"scene", one.scene},
                  {"set", set_text(one.set)},
                  {"loads", number_text(loads)},
                  {"solver", way.label}};
    try {
      int runs = 0;
      const AnalysisResult result = timed(way, run, request, runs);
      if (way.label == "newton") newton = result.state;
      fill(result, row);
      row["runs"] = fmt::format("{}", runs);
      row["difference"] = number_text(displacement_difference(result.state, newton));
      judge(study, way, loads, result, row);
    } catch (const std::exception& error) { // the other ways continue
      row["status"] = "failed";
      row["reason"] = error.what();
    }
    table.rows.push_back(std::move(row));
  }
}

} // namespace

StaticsStudy read_statics(const StudyFile& file) {
  ObjectNode scale(file.scale), object(file.part("statics"));
  const long most = scale.whole_or("most_elements", 1, Node::most_whole);
  scale.finish();
  StaticsStudy statics;
  statics.name = file.name;
  statics.title = file.title;
  statics.variant = object.name_or("variant", statics.variant);
  statics.bar = object.positive_or("bar", statics.bar);
  for (const Node& item : object.require("cases").items(1)) {
    ObjectNode place(item);
    StaticsCase one;
    one.scene = scene_beside(file.path, place.require("scene").name());
    one.small_loads = place.positive_or("small_loads", one.small_loads);
    one.settles = place.flag_or("settles", one.settles);
    const Sets sets = combinations(place, "set");
    place.finish();
    for (const std::vector<Override>& set : sets) {
      one.set = set;
      if (load_scene(one.scene, set).problem.lattice.element_count <= std::size_t(most))
        statics.cases.push_back(one);
    }
  }
  object.finish();
  return statics;
}

Table statics_table(const StaticsStudy& study) {
  Table table{statics_columns, {}};
  for (const StaticsCase& one : study.cases)
    for (const double loads : {1.0, one.small_loads}) add_rows(study, one, loads, table);
  return table;
}

std::string statics_text(const StaticsStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows) {
    const auto own = [&](const char* column, const char* form) { return shown(row, column, form); };
    rows.push_back({text_in(row, "scene"), text_in(row, "set"), own("loads", "{:g}"),
                    own("elements", "{:g}"), text_in(row, "solver"), own("wall_s", "{:.3g}"),
                    own("iterations", "{:g}"), own("cg_iterations", "{:g}"), own("steps", "{:g}"),
                    own("residual", "{:.1e}"), own("difference", "{:.1e}"), text_in(row, "status"),
                    text_in(row, "reason")});
  }
  return fmt::format(
      "{} ({})\n{}", study.title, study.name,
      text_table({"scene", "set", "loads", "elements", "solver", "wall [s]", "iterations", "of cg",
                  "steps", "residual", "to Newton", "status", ""},
                 rows));
}

} // namespace dss
