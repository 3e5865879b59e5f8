#include "experiments/base/text_table.hpp"
#include "experiments/studies/error_budget/error_budget.hpp"

#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

const Record* row_of(const Table& table, const std::string& label, const std::string& source) {
  for (const Record& row : table.rows)
    if (text_in(row, "label") == label && text_in(row, "source") == source &&
        !text_in(row, "error").empty())
      return &row;
  return nullptr;
}

/// The largest error that is not an error in time; null if there is none. Differences of grids
/// without a limit do not count as errors.
const Record* worst_other(const Table& table, const std::string& label) {
  const Record* worst = nullptr;
  for (const Record& row : table.rows)
    if (text_in(row, "label") == label && !text_in(row, "source").starts_with("time") &&
        text_in(row, "status") == "ok" &&
        (worst == nullptr || number_in(row, "error") > number_in(*worst, "error")))
      worst = &row;
  return worst;
}

/// Compares the error in time of a scene's step with its largest other error.
std::string step_text(const Table& table, const std::string& label) {
  const Record *time = row_of(table, label, "time"),
               *limit = row_of(table, label, "time at the stability limit"),
               *other = worst_other(table, label);
  if (time == nullptr || other == nullptr) return "";
  const double error = number_in(*time, "error"), rest = number_in(*other, "error");
  std::string text =
      fmt::format("{}: {} at dt = {} s is off by {:.1e} in time, {} by {:.1e}", label,
                  text_in(*time, "integrator"), shown(*time, "dt_s", "{:.3g}"), error,
                  text_in(*other, "source"), rest);
  if (text_in(*other, "source") == "space" && error < rest)
    text += fmt::format(": the step buys {:.1f} digits more than the grid has",
                        std::log10(rest / error));
  if (limit != nullptr && number_in(*limit, "dt_s") > number_in(*time, "dt_s"))
    text += fmt::format("; {:.3g} times that step is stable, and off by {:.1e}",
                        number_in(*limit, "dt_s") / number_in(*time, "dt_s"),
                        number_in(*limit, "error"));
  return text + ".\n";
}

} // namespace

std::string error_budget_text(const ErrorBudgetStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows) {
    const std::string order = shown(row, "observed_order", "{:.2f}"),
                      reason = text_in(row, "reason");
    rows.push_back({text_in(row, "label"), text_in(row, "source"), shown(row, "dt_s", "{:.3g}"),
                    shown(row, "error", "{:.1e}"), shown(row, "error_final", "{:.1e}"), order,
                    text_in(row, "status") + (reason.empty() ? "" : ": " + reason)});
  }
  std::string text = fmt::format(
      "{} ({}, scale {})\n{}Errors of displacements, relative to the largest: over all saved "
      "times, and at "
      "the last. Space: of the "
      "mean displacement of the loaded elements, by Richardson over three grids.\n\n",
      study.title, study.name, study.scale,
      text_table({"scene", "source", "dt [s]", "error", "at the end", "order", "status"}, rows));
  for (const BudgetScene& scene : study.scenes) {
    text += step_text(table, scene.label);
    if (!scene.refined.empty()) text += fmt::format("  Refinement keeps {}.\n", scene.refined);
  }
  return text;
}

} // namespace dss
