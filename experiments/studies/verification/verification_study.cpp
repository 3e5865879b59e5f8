#include "experiments/studies/verification/verification_study.hpp"

#include "experiments/base/text_table.hpp"
#include "experiments/measure/richardson.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

const std::vector<std::string> figure_columns = {
    "experiment", "problem",    "title",        "analysis",
    "figure",     "unit",       "reference",    "reference_uncertainty",
    "grids",      "finest",     "extrapolated", "extrapolated_uncertainty",
    "order",      "grid_error", "model_error",  "time_error",
    "tolerance",  "status",     "reason",       "source"};
const std::vector<std::string> grid_columns = {"experiment", "problem",  "figure", "refined",
                                               "value",      "elements", "result", "unit"};

/// All grids of a problem, and what a step of half the length changes on the coarsest.
struct Solved {
  std::vector<GridResult> grids;
  std::vector<double> time_change; ///< of each figure; empty unless it is a run in time
};

Solved solved(const VerificationProblem& problem) {
  Solved all;
  for (const double value : problem.values) all.grids.push_back(solve_grid(problem, value));
  if (problem.analysis != "dynamic") return all;
  const GridResult halved = solve_grid(problem, problem.values.front(), 2);
  for (std::size_t f = 0; f < problem.figures.size(); ++f)
    all.time_change.push_back(all.grids.front().figures[f] - halved.figures[f]);
  return all;
}

void judge(const VerificationProblem& problem, const VerifiedFigure& figure,
           const Extrapolation& limit, Record& row) {
  if (std::isnan(figure.reference)) {
    const double share = limit.uncertainty / std::abs(limit.value);
    row["status"] = share <= problem.tolerance ? "converges" : "failed";
    if (row["status"] == "failed")
      row["reason"] = fmt::format("uncertain by {:.2g} of its value, {:g} is allowed", share,
                                  problem.tolerance);
    return;
  }
  const double error = std::abs(limit.value - figure.reference),
               allowed = problem.tolerance * std::abs(figure.reference) + figure.uncertainty;
  row["status"] = error <= allowed ? "agrees" : figure.differs.empty() ? "failed" : "differs";
  if (row["status"] == "differs") row["reason"] = figure.differs;
  if (row["status"] == "failed")
    row["reason"] = fmt::format("{:.2g} from the reference, {:.2g} is allowed", error, allowed);
}

Record row_of(const VerificationStudy& study, const VerificationProblem& problem,
              const VerifiedFigure& figure) {
  return {{"experiment", study.name},
          {"problem", problem.name},
          {"title", problem.title},
          {"analysis", problem.analysis},
          {"figure", figure.name},
          {"unit", figure.unit},
          {"source", problem.source},
          {"tolerance", number_text(problem.tolerance)},
          {"reference", number_text(figure.reference)},
          {"reference_uncertainty", number_text(figure.uncertainty)}};
}

void add_figure(const VerificationProblem& problem, std::size_t f, const Solved& all, Record& row) {
  const VerifiedFigure& figure = problem.figures[f];
  std::vector<double> figures;
  for (const GridResult& grid : all.grids) figures.push_back(grid.figures[f]);
  const Extrapolation limit = extrapolated(problem.values, figures);
  const double whole = std::isnan(figure.reference) ? limit.value : figure.reference;
  row["grids"] = fmt::format("{}", figures.size());
  row["finest"] = number_text(figures.back());
  row["extrapolated"] = number_text(limit.value);
  row["extrapolated_uncertainty"] = number_text(limit.uncertainty);
  row["order"] = number_text(limit.order);
  row["grid_error"] = number_text((figures.back() - limit.value) / whole);
  row["model_error"] = number_text((limit.value - figure.reference) / whole);
  if (!all.time_change.empty()) row["time_error"] = number_text(all.time_change[f] / whole);
  judge(problem, figure, limit, row);
}

void add_problem(const VerificationStudy& study, const VerificationProblem& problem,
                 VerificationTables& tables) {
  Solved all;
  std::string fault;
  try {
    all = solved(problem);
  } catch (const std::exception& error) { // the other problems continue
    fault = error.what();
  }
  for (std::size_t f = 0; f < problem.figures.size(); ++f) {
    Record row = row_of(study, problem, problem.figures[f]);
    if (fault.empty())
      add_figure(problem, f, all, row);
    else
      row["status"] = "failed", row["reason"] = fault;
    tables.figures.rows.push_back(std::move(row));
    for (std::size_t n = 0; n < all.grids.size() && fault.empty(); ++n)
      tables.grids.rows.push_back({{"experiment", study.name},
                                   {"problem", problem.name},
                                   {"figure", problem.figures[f].name},
                                   {"refined", problem.refined},
                                   {"value", number_text(problem.values[n])},
                                   {"elements", fmt::format("{}", all.grids[n].elements)},
                                   {"result", number_text(all.grids[n].figures[f])},
                                   {"unit", problem.figures[f].unit}});
  }
}

} // namespace

Extrapolation extrapolated(const std::vector<double>& values, const std::vector<double>& figures) {
  const std::size_t count = figures.size();
  const auto limit_of_three = [&](std::size_t last) {
    std::vector<double> spacing, three;
    for (std::size_t n = last - 2; n <= last; ++n) {
      spacing.push_back(1 / values[n]);
      three.push_back(figures[n]);
    }
    Richardson limit = richardson(spacing, three);
    if (limit.order < 1)
      limit.limit = three[2] + (three[2] - three[1]) / (spacing[1] / spacing[2] - 1);
    return limit;
  };
  const Richardson limit = limit_of_three(count - 1);
  if (std::isnan(limit.order)) {
    const auto [low, high] =
        std::minmax({figures[count - 3], figures[count - 2], figures[count - 1]});
    return {figures.back(), high - low, limit.order};
  }
  Extrapolation found{limit.limit, std::abs(limit.limit - figures.back()) / 2, limit.order};
  if (count > 3)
    if (const Richardson before = limit_of_three(count - 2); !std::isnan(before.order))
      found.uncertainty = std::abs(limit.limit - before.limit);
  return found;
}

VerificationTables verification_tables(const VerificationStudy& study,
                                       const std::function<void(const std::string&)>& note) {
  VerificationTables tables{{figure_columns, {}}, {grid_columns, {}}};
  for (const VerificationProblem& problem : study.problems) {
    note(fmt::format("{}: {} grids", problem.name, problem.values.size()));
    add_problem(study, problem, tables);
  }
  return tables;
}

std::string verification_text(const VerificationStudy& study, const Table& figures) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : figures.rows) {
    const auto percent = [&](const char* column) { return shown(row, column, "{:+.2f} %", 100); };
    rows.push_back({text_in(row, "problem"), text_in(row, "figure"),
                    shown(row, "reference", "{:.6g}"), shown(row, "finest", "{:.6g}"),
                    shown(row, "extrapolated", "{:.6g}"),
                    shown(row, "extrapolated_uncertainty", "{:.1g}"), text_in(row, "unit"),
                    shown(row, "order", "{:.2f}"), percent("grid_error"), percent("model_error"),
                    percent("time_error"), text_in(row, "status"), text_in(row, "reason")});
  }
  return fmt::format("{} ({})\n{}", study.title, study.name,
                     text_table({"problem", "figure", "reference", "finest", "extrapolated", "+-",
                                 "unit", "order", "grid", "model", "time", "status", ""},
                                rows));
}

} // namespace dss
