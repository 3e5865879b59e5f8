#include "experiments/runner/tables.hpp"
#include "experiments/runner/device_columns.hpp"
#include "experiments/runner/scaling.hpp"
#include "experiments/runner/study_samples.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
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
                                      "ranks",
                                      "decomposition",
                                      "halo",
                                      "halo_used",
                                      "workers",
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
  columns.insert(columns.end(), scaling_columns().begin(), scaling_columns().end());
  columns.insert(columns.end(), device_columns().begin(), device_columns().end());
  for (const char* column :
       {"imbalance", "messages_per_step", "bytes_per_step", "communication_share", "resolution", "check", "check_error",
        "check_tolerance", "state_digest", "status", "reason", "paper_wall_s", "paper_speedup", "paper_source"})
    columns.emplace_back(column);
  return columns;
}

/// What differs from repetition to repetition of a cell on several ranks.
void put_exchange(const CellSample& sample, Record& row) {
  std::set<std::string> halos; // an automatic choice need not be the same each time
  std::vector<double> shares;
  for (const auto& [number, record] : sample.repetitions) {
    halos.insert(text_in(record, "halo_used"));
    if (const double share = number_in(record, "communication_share"); !std::isnan(share)) shares.push_back(share);
  }
  row["halo_used"] = fmt::format("{}", fmt::join(halos, " or "));
  if (!shares.empty()) row["communication_share"] = number_text(median(shares));
}

void put_speedups(const Study& study, const StudySamples& samples, const Cell& cell, Record& row) {
  for (const std::string& base : study.bases) {
    const Cell* other = one_rank_cell(study, cell, base, 1, cell.set_text());
    if (other == nullptr) continue;
    const bool is_scaled = cell.steps != other->steps;
    if (const auto speedup = samples.speedup(*other, cell))
      put_interval(row, (is_scaled ? "extrapolated_speedup_vs_" : "speedup_vs_") + base, *speedup);
  }
}

Record measured_row(const Study& study, const StudySamples& samples, const Cell& cell) {
  const CellSample* sample = samples.of(cell);
  Record row;
  put_identity(study, cell, sample == nullptr ? CellSample{} : *sample, row);
  if (sample == nullptr) {
    row["status"] = "not measured";
    return row;
  }
  if (sample->is_empty()) return row;
  put_times(study, cell, *sample, row);
  put_exchange(*sample, row);
  if (samples.is_unequal(cell)) {
    row["status"] = "wrong";
    row["reason"] = "its bits are not those of the other variants with FMA, threads, ranks or repetitions";
  }
  if (row["status"] == "ok" && sample->is_oversubscribed()) row["status"] = "oversubscribed";
  put_speedups(study, samples, cell, row);
  put_scaling(study, samples, cell, row);
  put_devices(study, samples, cell, row);
  return row;
}

Record published_row(const Study& study, const PaperRow& paper) {
  Record row = {{"experiment", study.name},
                {"source", "paper"},
                {"label", paper.label},
                {"set", paper.set},
                {"paper_wall_s", number_text(paper.wall_s)},
                {"paper_source", study.paper_source}};
  if (paper.speedup > 0) row["paper_speedup"] = number_text(paper.speedup);
  return row;
}

} // namespace

void put_identity(const Study& study, const Cell& cell, const CellSample& sample, Record& row) {
  row["experiment"] = study.name;
  row["scale"] = study.scale.name;
  row["source"] = "measured";
  row["label"] = cell.label();
  row["device"] = cell.device;
  row["hybrid"] = cell.hybrid;
  row["scene"] = cell.scene;
  row["set"] = cell.set_text();
  row["weak_base_set"] = cell.weak_base_set;
  row["variant"] = cell.variant;
  row["threads"] = fmt::format("{}", cell.threads);
  row["ranks"] = fmt::format("{}", cell.ranks);
  if (cell.ranks > 1) {
    row["decomposition"] = cell.decomposition;
    row["halo"] = cell.halo;
  }
  row["model"] = cell.model;
  row["precision"] = cell.precision;
  row["integrator"] = cell.integrator;
  row["steps"] = fmt::format("{}", cell.steps);
  for (const char* column : {"isa", "workers", "cores", "elements", "status", "reason", "check_tolerance",
                             "state_digest", "imbalance", "messages_per_step", "bytes_per_step"})
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
  const std::vector<Record> own = records_of_scale(study, records);
  const StudySamples samples(study, own);
  const std::optional<double> resolution = resolution_of(own);
  Table table{table_columns(study), {}};
  for (const Cell& cell : study.cells) {
    table.rows.push_back(measured_row(study, samples, cell));
    if (resolution) table.rows.back()["resolution"] = number_text(*resolution);
  }
  for (const PaperRow& paper : study.paper) table.rows.push_back(published_row(study, paper));
  return table;
}

} // namespace dss
