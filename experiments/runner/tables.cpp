#include "experiments/runner/tables.hpp"
#include "experiments/runner/samples.hpp"
#include "experiments/runner/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace dss {
namespace {

std::vector<std::string> table_columns(const Study& study) {
  std::vector<std::string> columns = {"experiment",
                                      "scale",
                                      "source",
                                      "label",
                                      "scene",
                                      "set",
                                      "variant",
                                      "isa",
                                      "threads",
                                      "cores",
                                      "model",
                                      "precision",
                                      "integrator",
                                      "elements",
                                      "steps",
                                      "repetitions",
                                      "contaminated",
                                      "short",
                                      "outliers",
                                      "measured_wall_s",
                                      "measured_wall_low_s",
                                      "measured_wall_high_s",
                                      "half_width",
                                      "converged",
                                      "extrapolated_wall_s",
                                      "extrapolated_to_steps",
                                      "element_steps_per_s"};
  for (const std::string& base : study.bases)
    for (const char* form : {"speedup_vs_{}", "speedup_vs_{}_low", "speedup_vs_{}_high", "extrapolated_speedup_vs_{}",
                             "extrapolated_speedup_vs_{}_low", "extrapolated_speedup_vs_{}_high"})
      columns.push_back(fmt::format(fmt::runtime(form), base));
  for (const char* column : {"resolution", "check", "check_error", "check_tolerance", "state_digest", "status",
                             "reason", "paper_wall_s", "paper_speedup", "paper_source"})
    columns.emplace_back(column);
  return columns;
}

/// Digests of problems on which cells that must agree to the last bit do not.
class DigestCheck {
public:
  DigestCheck(const Study& study, const std::map<std::string, const CellSample*>& samples) {
    std::map<std::string, std::set<std::string>> digests;
    for (const Cell& cell : study.cells)
      if (const auto sample = samples.find(cell.key()); sample != samples.end())
        for (const auto& [number, record] : sample->second->repetitions)
          digests[group(cell, record)].insert(text_in(record, "state_digest"));
    for (const auto& [name, found] : digests)
      if (found.size() > 1) unequal_.insert(name);
  }
  bool is_unequal(const Cell& cell, const CellSample& sample) const {
    return !sample.is_empty() && unequal_.contains(group(cell, sample.repetitions.begin()->second));
  }

private:
  /// All variants with FMA form one group of a problem; of the others each agrees with itself, over its threads too.
  static std::string group(const Cell& cell, const Record& record) {
    return cell.problem_key() + " " + (text_in(record, "has_fma") == "true" ? "FMA" : cell.variant);
  }
  std::set<std::string> unequal_;
};

std::string label_of(const Cell& cell) {
  return fmt::format("{}, {} thread{}{}", cell.variant, cell.threads, cell.threads == 1 ? "" : "s",
                     cell.is_twin ? " (A/A)" : "");
}

/// The base's cell for a cell: the same physics, on one thread, with as many steps as the base has.
const Cell* base_of(const Study& study, const std::string& base, const Cell& cell) {
  for (const Cell& other : study.cells)
    if (other.variant == base && other.threads == 1 && !other.is_twin && other.scene == cell.scene &&
        other.set_text() == cell.set_text() && other.model == cell.model && other.precision == cell.precision &&
        other.integrator == cell.integrator)
      return &other;
  return nullptr;
}

void put_interval(Record& row, const std::string& column, const Estimate& estimate) {
  row[column] = number_text(estimate.median);
  if (!estimate.interval) return;
  row[column + "_low"] = number_text(estimate.interval->low);
  row[column + "_high"] = number_text(estimate.interval->high);
}

void put_identity(const Study& study, const Cell& cell, const CellSample& sample, Record& row) {
  row["experiment"] = study.name;
  row["scale"] = study.scale.name;
  row["source"] = "measured";
  row["label"] = label_of(cell);
  row["scene"] = cell.scene;
  row["set"] = cell.set_text();
  row["variant"] = cell.variant;
  row["threads"] = fmt::format("{}", cell.threads);
  row["model"] = cell.model;
  row["precision"] = cell.precision;
  row["integrator"] = cell.integrator;
  row["steps"] = fmt::format("{}", cell.steps);
  for (const char* column : {"isa", "cores", "elements", "status", "reason", "check_tolerance", "state_digest"})
    row[column] = text_in(sample.last, column);
}

void put_times(const Study& study, const Cell& cell, const CellSample& sample, Record& row) {
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
  row["converged"] = wall.half_width() && *wall.half_width() <= study.scale.half_width ? "yes" : "no";
  row["element_steps_per_s"] = number_text(number_in(sample.last, "elements") * double(cell.steps) / wall.median);
  if (cell.steps < cell.full_steps) {
    row["extrapolated_wall_s"] = number_text(wall.median * double(cell.full_steps) / double(cell.steps));
    row["extrapolated_to_steps"] = fmt::format("{}", cell.full_steps);
  }
  row["check"] = sample.check();
  row["check_error"] = number_text(sample.check_error());
}

} // namespace

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
      const Interval reach = ratio.interval.value_or(
          Interval{*std::min_element(ratios.begin(), ratios.end()), *std::max_element(ratios.begin(), ratios.end())});
      resolution = std::max({resolution.value_or(0), std::abs(reach.low - 1), std::abs(reach.high - 1)});
    }
  }
  return resolution;
}

Table derive_table(const Study& study, const std::vector<Record>& records) {
  std::vector<Record> own; // a resumed file may hold other scales of the study
  for (const Record& record : records)
    if (text_in(record, "scale") == study.scale.name) own.push_back(record);
  const std::vector<CellSample> samples = samples_of(own);
  std::map<std::string, const CellSample*> by_key;
  for (const CellSample& sample : samples) by_key[sample.key] = &sample;
  const DigestCheck digests(study, by_key);
  const std::optional<double> resolution = resolution_of(own);
  const auto sample_of = [&](const Cell& cell) {
    const auto found = by_key.find(cell.key());
    return found == by_key.end() ? nullptr : found->second;
  };
  const auto may_compare = [&](const Cell& cell, const CellSample* sample) {
    return sample != nullptr && !sample->is_empty() && sample->check() == "passed" &&
           text_in(sample->last, "status") == "ok" && !digests.is_unequal(cell, *sample) &&
           number_in(sample->last, "threads") <= number_in(sample->last, "cores");
  };
  Table table{table_columns(study), {}};
  for (const Cell& cell : study.cells) {
    const CellSample* sample = sample_of(cell);
    Record row;
    put_identity(study, cell, sample == nullptr ? CellSample{} : *sample, row);
    if (sample == nullptr) row["status"] = "not measured";
    if (sample != nullptr && !sample->is_empty()) {
      put_times(study, cell, *sample, row);
      if (digests.is_unequal(cell, *sample)) {
        row["status"] = "wrong";
        row["reason"] = "its bits are not those of the other variants with FMA, threads or repetitions";
      }
      if (row["status"] == "ok" && cell.threads > number_in(sample->last, "cores")) row["status"] = "oversubscribed";
    }
    for (const std::string& base : study.bases) {
      const Cell* other = base_of(study, base, cell);
      const CellSample* base_sample = other == nullptr ? nullptr : sample_of(*other);
      if (other == nullptr || !may_compare(cell, sample) || !may_compare(*other, base_sample)) continue;
      const std::vector<double> ratios = paired_ratios(*base_sample, *sample);
      const bool is_scaled = cell.steps != other->steps;
      if (!ratios.empty())
        put_interval(row, (is_scaled ? "extrapolated_speedup_vs_" : "speedup_vs_") + base, estimate(ratios));
    }
    if (resolution) row["resolution"] = number_text(*resolution);
    table.rows.push_back(std::move(row));
  }
  for (const PaperRow& paper : study.paper) {
    Record row = {{"experiment", study.name},
                  {"source", "paper"},
                  {"label", paper.label},
                  {"paper_wall_s", number_text(paper.wall_s)},
                  {"paper_source", study.paper_source}};
    if (paper.speedup > 0) row["paper_speedup"] = number_text(paper.speedup);
    table.rows.push_back(std::move(row));
  }
  return table;
}

} // namespace dss
