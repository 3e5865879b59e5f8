#include "experiments/studies/speedup/speedup_table.hpp"
#include "experiments/measure/cell_bases.hpp"
#include "experiments/measure/cell_record.hpp"
#include "experiments/measure/cell_rows.hpp"
#include "experiments/measure/study_samples.hpp"
#include "experiments/studies/speedup/device_columns.hpp"
#include "experiments/studies/speedup/scaling.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace dss {
namespace {

std::vector<std::string> table_columns(const SpeedupStudy& study) {
  std::vector<std::string> columns = identity_columns();
  columns.insert(columns.end(),
                 {"repetitions", "contaminated", "short", "outliers", "measured_wall_s",
                  "measured_wall_low_s", "measured_wall_high_s", "half_width", "converged",
                  "extrapolated_wall_s", "extrapolated_to_steps", "scaling_error",
                  "element_steps_per_s", "link_steps_per_s"});
  for (const std::string& base : study.bases)
    for (const char* form :
         {"speedup_vs_{}", "speedup_vs_{}_low", "speedup_vs_{}_high", "extrapolated_speedup_vs_{}",
          "extrapolated_speedup_vs_{}_low", "extrapolated_speedup_vs_{}_high"})
      columns.push_back(fmt::format(fmt::runtime(form), base));
  for (const std::vector<std::string>& more : {scaling_columns(),
                                               device_columns(),
                                               {"resolution", "check", "check_error"},
                                               run_columns(),
                                               {"paper_wall_s", "paper_speedup", "paper_source"}})
    columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

void put_speedups(const SpeedupStudy& study, const StudySamples& samples, const Cell& cell,
                  Record& row) {
  for (const std::string& base : study.bases) {
    const Cell* other = one_rank_cell(study, cell, base, 1, cell.set_text());
    if (other == nullptr) continue;
    const bool is_scaled = cell.steps != other->steps;
    if (const auto speedup = samples.speedup(*other, cell))
      put_interval(row, (is_scaled ? "extrapolated_speedup_vs_" : "speedup_vs_") + base, *speedup);
  }
}

/// Error of scaling a time to all steps, from one run of all steps.
void put_scaling_error(const SpeedupStudy& study, const StudySamples& samples, const Cell& cell,
                       Record& row) {
  if (cell.is_whole_once || cell.is_twin || cell.steps == cell.full_steps) return;
  Cell whole = cell;
  whole.steps = cell.full_steps;
  const auto run = std::ranges::find_if(study.cells, [&](const Cell& other) {
    return other.is_whole_once && other.key() == whole.key();
  });
  if (run == study.cells.end()) return;
  const CellSample* sample = samples.of(*run);
  if (sample == nullptr || sample->is_empty()) return;
  row["scaling_error"] =
      number_text(number_in(row, "extrapolated_wall_s") / number_in(sample->last, "wall_s") - 1);
}

Record measured_row(const SpeedupStudy& study, const StudySamples& samples, const Cell& cell) {
  const CellSample* sample = samples.of(cell);
  Record row;
  put_identity(study, cell, sample == nullptr ? CellSample{} : *sample, row);
  if (sample == nullptr) {
    row["status"] = "not measured";
    return row;
  }
  if (sample->is_empty()) return row;
  put_times(study, cell, *sample, row);
  if (samples.is_unequal(cell)) {
    row["status"] = "wrong";
    row["reason"] =
        "its bits are not those of the other variants with FMA, threads, ranks or repetitions";
  }
  if (row["status"] == "ok" && sample->is_oversubscribed()) row["status"] = "oversubscribed";
  if (row["status"] == "ok" && cell.is_whole_once) row["status"] = "once";
  put_scaling_error(study, samples, cell, row);
  put_speedups(study, samples, cell, row);
  put_scaling(study, samples, cell, row);
  put_devices(study, samples, cell, row);
  return row;
}

Record published_row(const SpeedupStudy& study, const PaperRow& paper) {
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

Table derive_table(const SpeedupStudy& study, const std::vector<Record>& records) {
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
