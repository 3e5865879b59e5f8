/// How many times cheaper one method is than another where both are as accurate as the space
/// discretisation.
#include "experiments/studies/work_precision/points.hpp"
#include "experiments/studies/work_precision/precision_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

bool is_of(const Record& row, const std::string& scene, const Contender& contender) {
  const double dt = number_in(row, "dt_s");
  return text_in(row, "scene") == scene && text_in(row, "integrator") == contender.integrator &&
         text_in(row, "rtol").empty() && text_in(row, "precision") == contender.precision &&
         (contender.dt == 0 || std::abs(dt - contender.dt) <= 1e-6 * contender.dt);
}

/// Median ratio of the times of two points over the rounds that both have.
std::optional<Estimate> times_cheaper(const PrecisionStudy& study, const StudySamples& samples,
                                      const Record& base, const Record& row) {
  const auto sample_of = [&](const Record& wanted) -> const CellSample* {
    for (const Cell& cell : study.cells)
      if (problem_of(wanted) == cell.scene + " " + cell.set_text() + " " +
                                    number_text(study.accuracy_of(cell).times.end) &&
          text_in(wanted, "label") == cell.label() &&
          text_in(wanted, "precision") == cell.precision &&
          text_in(wanted, "integrator") == cell.integrator &&
          text_in(wanted, "steps") == fmt::format("{}", cell.steps))
        return samples.of(cell);
    return nullptr;
  };
  const CellSample *of_base = sample_of(base), *of_row = sample_of(row);
  if (of_base == nullptr || of_row == nullptr) return {};
  std::vector<double> ratios;
  for (const auto& [number, record] : of_base->repetitions)
    if (const auto pair = of_row->repetitions.find(number); pair != of_row->repetitions.end())
      ratios.push_back(number_in(record, "wall_s") / number_in(pair->second, "wall_s"));
  if (ratios.empty()) return {};
  return estimate(ratios);
}

double error_in_space(const Table& budget, const std::string& label) {
  for (const Record& row : budget.rows)
    if (text_in(row, "label") == label && text_in(row, "source") == "space" &&
        text_in(row, "status") == "ok")
      return number_in(row, "error");
  return std::nan("");
}

Record comparison_row(const PrecisionStudy& study, const StudySamples& samples, const Table& points,
                      const CostComparison& asked, double error) {
  Record row = {{"experiment", study.name},
                {"scale", study.scale.name},
                {"scene", asked.scene},
                {"space", asked.space},
                {"space_error", number_text(error)},
                {"contender", asked.contender.integrator + " " + asked.contender.precision},
                {"base", asked.base.integrator + " " + asked.base.precision},
                {"status", "none"}};
  if (std::isnan(error)) {
    row["reason"] =
        "no error in space: run `dssbench experiment error_budget` with the same --out before";
    return row;
  }
  const Record* base = least(points, "measured_wall_s",
                             [&](const Record& p) { return is_of(p, asked.scene, asked.base); });
  const auto is_enough = [&](const Record& p) { return number_in(p, "error_max") <= error; };
  const auto is_like_base = [&](const Record& p) {
    return base != nullptr && text_in(p, "variant") == text_in(*base, "variant");
  };
  const Record* best = least(points, "measured_wall_s", [&](const Record& p) {
    return is_of(p, asked.scene, asked.contender) && is_like_base(p) && is_enough(p);
  });
  const Record* best_base = least(points, "measured_wall_s", [&](const Record& p) {
    return is_of(p, asked.scene, {asked.base.integrator, asked.base.precision, 0}) &&
           is_like_base(p) && is_enough(p);
  });
  if (base == nullptr || best == nullptr) {
    row["reason"] = base == nullptr ? "the base was not measured"
                                    : "no step of the contender is accurate enough";
    return row;
  }
  row["status"] = "ok";
  row["variant"] = text_in(*base, "variant");
  for (const auto& [name, point] : {std::pair{"base", base}, std::pair{"contender", best}})
    for (const char* column : {"dt_s", "error_max", "measured_wall_s"})
      row[fmt::format("{}_{}", name, column)] = text_in(*point, column);
  if (const auto ratio = times_cheaper(study, samples, *base, *best))
    put_interval(row, "times_cheaper", *ratio);
  if (best_base != nullptr) {
    row["best_base_dt_s"] = text_in(*best_base, "dt_s");
    if (const auto ratio = times_cheaper(study, samples, *best_base, *best))
      put_interval(row, "times_cheaper_than_best_base", *ratio);
  }
  return row;
}

} // namespace

Table comparison_table(const PrecisionStudy& study, const Table& points,
                       const std::vector<Record>& records, const Table& budget) {
  Table table{{"experiment",
               "scale",
               "scene",
               "space",
               "space_error",
               "variant",
               "base",
               "base_dt_s",
               "base_error_max",
               "base_measured_wall_s",
               "contender",
               "contender_dt_s",
               "contender_error_max",
               "contender_measured_wall_s",
               "times_cheaper",
               "times_cheaper_low",
               "times_cheaper_high",
               "best_base_dt_s",
               "times_cheaper_than_best_base",
               "times_cheaper_than_best_base_low",
               "times_cheaper_than_best_base_high",
               "status",
               "reason"},
              {}};
  const std::vector<Record> own = records_of_scale(study, records);
  const StudySamples samples(study, own);
  for (const CostComparison& asked : study.rules.comparisons)
    table.rows.push_back(
        comparison_row(study, samples, points, asked, error_in_space(budget, asked.space)));
  return table;
}

} // namespace dss
