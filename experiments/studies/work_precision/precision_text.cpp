#include "experiments/studies/work_precision/precision_text.hpp"
#include "experiments/base/text_table.hpp"

#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

std::string shown_time(const Record& row) {
  const double half = number_in(row, "half_width");
  const std::string time = shown(row, "measured_wall_s", "{:.3g}");
  return std::isnan(half) ? time : fmt::format("{} ± {:.1f} %", time, 100 * half);
}

std::string shown_step(const Record& row) {
  return text_in(row, "rtol").empty() ? shown(row, "dt_s", "{:.3g}")
                                      : "rtol " + shown(row, "rtol", "{:g}");
}

std::string shown_status(const Record& row) {
  const std::string status = text_in(row, "status"), reason = text_in(row, "reason");
  return (reason.empty() ? status : status + ": " + reason) +
         (text_in(row, "below_reference") == "yes" ? ", below 10 x the reference's error" : "") +
         (number_in(row, "short") > 0 ? ", short samples" : "");
}

std::string points_text(const Table& points) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : points.rows)
    rows.push_back({text_in(row, "scene"), text_in(row, "set"), text_in(row, "label"),
                    text_in(row, "precision"), text_in(row, "integrator"), shown_step(row),
                    shown(row, "evaluations", "{:.3g}"), text_in(row, "repetitions"),
                    shown_time(row), shown(row, "error_final", "{:.1e}"),
                    shown(row, "error_l2", "{:.1e}"), shown(row, "error_max", "{:.1e}"),
                    shown(row, "energy_drift", "{:.1e}"),
                    text_in(row, "pareto") == "yes" ? "*" : "", shown_status(row)});
  return text_table({"scene", "set", "cell", "precision", "integrator", "step [s]", "evaluations",
                     "n", "wall [s]", "final", "l2", "max", "energy", "front", "status"},
                    rows);
}

std::string cheapest_text(const Table& cheapest) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : cheapest.rows)
    rows.push_back({text_in(row, "scene"), text_in(row, "set"), shown(row, "tolerance", "{:.0e}"),
                    text_in(row, "label"), text_in(row, "precision"), text_in(row, "integrator"),
                    shown_step(row), shown(row, "error_max", "{:.1e}"),
                    shown(row, "measured_wall_s", "{:.3g}"), text_in(row, "reason")});
  return text_table({"scene", "set", "tolerance", "cell", "precision", "integrator", "step [s]",
                     "error", "wall [s]", "note"},
                    rows);
}

std::string comparison_text(const Record& row) {
  const std::string question = fmt::format("{} against {} on {}", text_in(row, "contender"),
                                           text_in(row, "base"), text_in(row, "scene"));
  if (text_in(row, "status") != "ok")
    return fmt::format("{}: {}\n", question, text_in(row, "reason"));
  const auto factor = [&](const std::string& column) {
    const std::string interval =
        text_in(row, column + "_low").empty()
            ? ""
            : fmt::format(" [{}, {}]", shown(row, column + "_low", "{:.1f}"),
                          shown(row, column + "_high", "{:.1f}"));
    return shown(row, column, "{:.1f}") + interval;
  };
  std::string text =
      fmt::format("{} ({}): within the error of space discretisation, {} ({}), dt = {} s (error "
                  "{}) is {} times "
                  "cheaper than dt = {} s "
                  "(error {})",
                  question, text_in(row, "variant"), shown(row, "space_error", "{:.1e}"),
                  text_in(row, "space"), shown(row, "contender_dt_s", "{:.3g}"),
                  shown(row, "contender_error_max", "{:.1e}"), factor("times_cheaper"),
                  shown(row, "base_dt_s", "{:.3g}"), shown(row, "base_error_max", "{:.1e}"));
  if (!text_in(row, "best_base_dt_s").empty())
    text += fmt::format(
        ", and {} times cheaper than the base at the largest step that is accurate enough, {} s",
        factor("times_cheaper_than_best_base"), shown(row, "best_base_dt_s", "{:.3g}"));
  return text + ".\n";
}

} // namespace

std::string precision_text(const PrecisionStudy& study, const Table& points, const Table& cheapest,
                           const Table& comparisons) {
  std::string text = fmt::format(
      "{} ({}, scale {})\n{}Errors: displacements against the solution, relative to the largest "
      "displacement; front: nothing "
      "is both faster and closer (max).\n\nCheapest for each tolerance (max):\n{}\n",
      study.title, study.name, study.scale.name, points_text(points), cheapest_text(cheapest));
  for (const Record& row : comparisons.rows) text += comparison_text(row);
  return text;
}

} // namespace dss
