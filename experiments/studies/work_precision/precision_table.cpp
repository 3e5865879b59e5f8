#include "experiments/studies/work_precision/precision_table.hpp"
#include "experiments/measure/cell_rows.hpp"
#include "experiments/studies/work_precision/points.hpp"
#include "solver/numerics/method.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace dss {
namespace {

constexpr double reference_margin =
    10; ///< an error below so many times that of the solution says little

const std::vector<std::string>& error_columns() {
  static const std::vector<std::string> columns = {"error_final",    "error_l2",       "error_max",
                                                   "error_rotation", "error_velocity", "error_spin",
                                                   "energy_drift",   "reference_error"};
  return columns;
}

std::vector<std::string> columns() {
  std::vector<std::string> all = {"experiment",
                                  "scale",
                                  "source",
                                  "label",
                                  "scene",
                                  "set",
                                  "end_time_s",
                                  "saved_times",
                                  "variant",
                                  "isa",
                                  "threads",
                                  "cores",
                                  "workers",
                                  "model",
                                  "precision",
                                  "integrator",
                                  "order",
                                  "stages",
                                  "dt_s",
                                  "rtol",
                                  "steps",
                                  "elements",
                                  "evaluations",
                                  "repetitions",
                                  "contaminated",
                                  "short",
                                  "outliers",
                                  "measured_wall_s",
                                  "measured_wall_low_s",
                                  "measured_wall_high_s",
                                  "half_width",
                                  "converged",
                                  "first_step_s",
                                  "factorisations",
                                  "factor_s",
                                  "factor_bytes"};
  all.insert(all.end(), error_columns().begin(), error_columns().end());
  all.insert(all.end(), {"below_reference", "pareto", "state_digest", "status", "reason"});
  return all;
}

/// `sample`: its last record says how many stages ran, which rkc2 fits to its step, and how many
/// steps, if they adapt.
void put_point(const Cell& cell, const SavedTimes& times, const CellSample* sample, Record& row) {
  row["dt_s"] = number_text(cell.dt);
  row["end_time_s"] = number_text(times.end);
  row["saved_times"] = fmt::format("{}", times.count);
  const Method* method = find_method(cell.integrator);
  if (method == nullptr) return;
  const auto recorded = [&](const char* column, std::string otherwise) {
    const std::string text = sample == nullptr ? "" : text_in(sample->last, column);
    return text.empty() ? otherwise : text;
  };
  for (const char* column : {"first_step_s", "factorisations", "factor_s", "factor_bytes"})
    row[column] = recorded(column, "");
  row["order"] = fmt::format("{}", method->order);
  row["stages"] = recorded("stages", fmt::format("{}", method->stages));
  if (cell.rtol > 0) {
    row["rtol"] = fmt::format("{}", cell.rtol);
    row["steps"] = recorded("accepted_steps", "");
  }
  if (method->is_implicit() || (cell.rtol > 0 && row["steps"].empty()) ||
      (method->is_exponential && sample == nullptr))
    return; // nobody knows how many
  const double planned = number_in(row, "stages") * double(cell.steps);
  row["evaluations"] = number_text(std::stod(recorded("evaluations", number_text(planned))) *
                                   number_in(row, "elements"));
}

/// Errors differ between repetitions only if the bits do, which StudySamples sees.
void put_errors(const CellSample& sample, Record& row) {
  for (const std::string& column : error_columns()) row[column] = text_in(sample.last, column);
  const double error = number_in(row, "error_max");
  row["below_reference"] =
      error < reference_margin * number_in(row, "reference_error") ? "yes" : "no";
  if (row["status"] == "ok" && !(error < 1)) {
    row["status"] = "inaccurate";
    row["reason"] = fmt::format("error {:.2g}: no correct digit", error);
  }
}

/// Only a step above the limit may be refused or unstable: below it that is a failure of the
/// program.
void judge_stability(const Cell& cell, double step_limit, Record& row) {
  const std::string status = row["status"];
  if ((status != "refused" && status != "unstable") || cell.rtol > 0 || cell.dt == 0 ||
      cell.dt > step_limit)
    return;
  row["status"] = "failed";
  row["reason"] =
      fmt::format("{} below its stability limit {:.6g} s: {}", status, step_limit, row["reason"]);
}

Record point_row(const PrecisionStudy& study, const StudySamples& samples, const Cell& cell) {
  const CellSample* sample = samples.of(cell);
  Record row;
  put_identity(study, cell, sample == nullptr ? CellSample{} : *sample, row);
  const CellAccuracy& of = study.accuracy_of(cell);
  put_point(cell, of.times, sample, row);
  if (sample == nullptr) row["status"] = "not measured";
  judge_stability(cell, of.step_limit, row);
  if (sample == nullptr || sample->is_empty()) return row;
  put_times(study, cell, *sample, row);
  put_errors(*sample, row);
  if (samples.is_unequal(cell)) {
    row["status"] = "wrong";
    row["reason"] = "its bits are not those of the other variants with FMA, threads or repetitions";
  }
  return row;
}

bool is_dominated(const Record& row, const Record& by) {
  const double error = number_in(row, "error_max"), time = number_in(row, "measured_wall_s");
  const double other_error = number_in(by, "error_max"),
               other_time = number_in(by, "measured_wall_s");
  return other_error <= error && other_time <= time && (other_error < error || other_time < time);
}

void mark_front(std::vector<Record>& rows) {
  for (Record& row : rows) {
    if (!is_comparable(row)) continue;
    const bool is_behind = std::ranges::any_of(rows, [&](const Record& by) {
      return is_comparable(by) && problem_of(by) == problem_of(row) && is_dominated(row, by);
    });
    row["pareto"] = is_behind ? "no" : "yes";
  }
}

Record cheapest_row(const Record& first, const Table& points, double tolerance) {
  const auto is_here = [&](const Record& row) { return problem_of(row) == problem_of(first); };
  const Record* best = least(points, "measured_wall_s", [&](const Record& row) {
    return is_here(row) &&
           number_in(row, "error_max") + number_in(row, "reference_error") <= tolerance;
  });
  Record row;
  for (const char* column : {"experiment", "scale", "scene", "set", "end_time_s"})
    row[column] = text_in(first, column);
  row["tolerance"] = number_text(tolerance);
  row["status"] = best == nullptr ? "none" : "ok";
  if (best != nullptr) {
    for (const char* column :
         {"label", "variant", "precision", "integrator", "dt_s", "rtol", "steps", "evaluations",
          "error_max", "measured_wall_s", "measured_wall_low_s", "measured_wall_high_s"})
      row[column] = text_in(*best, column);
    return row;
  }
  const Record* nearest = least(points, "error_max", is_here);
  row["reason"] =
      nearest == nullptr
          ? "no point was measured"
          : fmt::format("the smallest error is {:.2g} (the solution's own {:.1g})",
                        number_in(*nearest, "error_max"), number_in(*nearest, "reference_error"));
  return row;
}

} // namespace

Table precision_table(const PrecisionStudy& study, const std::vector<Record>& records) {
  const std::vector<Record> own = records_of_scale(study, records);
  const StudySamples samples(study, own);
  Table table{columns(), {}};
  for (const Cell& cell : study.cells) table.rows.push_back(point_row(study, samples, cell));
  mark_front(table.rows);
  return table;
}

Table cheapest_table(const PrecisionStudy& study, const Table& points) {
  Table table{{"experiment",
               "scale",
               "scene",
               "set",
               "end_time_s",
               "tolerance",
               "label",
               "variant",
               "precision",
               "integrator",
               "dt_s",
               "rtol",
               "steps",
               "evaluations",
               "error_max",
               "measured_wall_s",
               "measured_wall_low_s",
               "measured_wall_high_s",
               "status",
               "reason"},
              {}};
  std::set<std::string> done;
  for (const Record& first : points.rows)
    if (done.insert(problem_of(first)).second)
      for (const double tolerance : study.rules.tolerances)
        table.rows.push_back(cheapest_row(first, points, tolerance));
  return table;
}

} // namespace dss
