#include "experiments/measure/cell_rows.hpp"
#include "experiments/measure/cell_record.hpp"
#include "experiments/run/timed/run_fields.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace dss {
namespace {

std::string distinct_texts(const CellSample& sample, const char* column) {
  std::set<std::string> texts;
  for (const auto& [repetition, record] : sample.repetitions) texts.insert(text_in(record, column));
  return fmt::format("{}", fmt::join(texts, " or "));
}

std::string aggregated(const RunField& field, const CellSample& sample) {
  if (field.in_tables == Aggregate::last) return text_in(sample.last, field.column);
  if (field.in_tables == Aggregate::distinct) return distinct_texts(sample, field.column);
  const std::vector<double> numbers = numbers_of(sample, field.column);
  if (numbers.empty()) return "";
  return number_text(field.in_tables == Aggregate::median ? median(numbers)
                                                          : *std::ranges::max_element(numbers));
}

} // namespace

std::vector<std::string> run_columns() {
  std::vector<std::string> columns;
  for (const RunField& field : run_fields())
    if (field.in_tables != Aggregate::none) columns.emplace_back(field.column);
  return columns;
}

void put_run_fields(const CellSample& sample, Record& row) {
  for (const RunField& field : run_fields())
    if (field.in_tables != Aggregate::none) row[field.column] = aggregated(field, sample);
  // One wrong repetition makes the cell wrong: often only the first is checked by the oracle.
  row["status"] = sample.status();
  row["reason"] = sample.reason();
}

void put_identity(const CellStudy& study, const Cell& cell, const CellSample& sample, Record& row) {
  put_identity({study, cell}, row);
  row["weak_base_set"] = cell.weak_base_set;
  row["cores"] = text_in(sample.last, "cores");
  put_run_fields(sample, row);
}

void put_times(const CellStudy& study, const Cell& cell, const CellSample& sample, Record& row) {
  const std::vector<double> times = sample.wall_s();
  const Estimate wall = estimate(times);
  row["repetitions"] = fmt::format("{}", times.size());
  row["contaminated"] = fmt::format("{}", sample.contaminated);
  row["short"] = fmt::format("{}", sample.too_short);
  row["outliers"] = fmt::format("{}", outliers(times).size());
  row["measured_wall_s"] = number_text(wall.median);
  if (wall.interval) {
    row["measured_wall_low_s"] = number_text(wall.interval->low);
    row["measured_wall_high_s"] = number_text(wall.interval->high);
  }
  if (const auto half = wall.half_width()) row["half_width"] = number_text(*half);
  row["converged"] =
      wall.half_width() && *wall.half_width() <= study.scale.half_width ? "yes" : "no";
  row["element_steps_per_s"] =
      number_text(number_in(sample.last, "elements") * double(cell.steps) / wall.median);
  const double links_per_element =
      number_in(sample.last, "links") / number_in(sample.last, "elements");
  row["link_steps_per_s"] = number_text(number_in(row, "element_steps_per_s") * links_per_element);
  if (cell.steps < cell.full_steps) {
    row["extrapolated_wall_s"] =
        number_text(wall.median * double(cell.full_steps) / double(cell.steps));
    row["extrapolated_to_steps"] = fmt::format("{}", cell.full_steps);
  }
  row["check"] = sample.check();
  row["check_error"] = number_text(sample.check_error());
}

std::optional<double> resolution_of(const std::vector<Record>& records) {
  const std::vector<CellSample> samples = samples_of(records);
  std::optional<double> resolution;
  for (const CellSample& twin : samples) {
    if (text_in(twin.last, "twin") != "true") continue;
    for (const CellSample& original : samples) {
      if (original.key + " (A/A)" != twin.key) continue;
      const std::vector<double> ratios = paired_ratios(original, twin);
      if (ratios.empty()) continue;
      const Estimate ratio = estimate(ratios);
      const Interval reach =
          ratio.interval.value_or(Interval{*std::min_element(ratios.begin(), ratios.end()),
                                           *std::max_element(ratios.begin(), ratios.end())});
      resolution =
          std::max({resolution.value_or(0), std::abs(reach.low - 1), std::abs(reach.high - 1)});
    }
  }
  return resolution;
}

bool is_without_failures(const Table& table) {
  static const std::set<std::string> fine = {"",        "ok",          "once",
                                             "skipped", "unavailable", "oversubscribed",
                                             "refused", "unstable",    "inaccurate"};
  return std::ranges::all_of(
      table.rows, [](const Record& row) { return fine.contains(text_in(row, "status")); });
}

} // namespace dss
