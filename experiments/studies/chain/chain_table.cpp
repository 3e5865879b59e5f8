#include "experiments/studies/chain/chain_table.hpp"
#include "experiments/base/statistics.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/samples.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

const std::vector<std::string>& chain_columns() {
  static const std::vector<std::string> columns = {"experiment",
                                                   "scale",
                                                   "stage",
                                                   "label",
                                                   "scene",
                                                   "set",
                                                   "variant",
                                                   "threads",
                                                   "model",
                                                   "precision",
                                                   "integrator",
                                                   "dt_s",
                                                   "end_time_s",
                                                   "steps",
                                                   "timed_steps",
                                                   "repetitions",
                                                   "contaminated",
                                                   "measured_wall_s",
                                                   "measured_wall_low_s",
                                                   "measured_wall_high_s",
                                                   "extrapolated_wall_s",
                                                   "factor_of_stage",
                                                   "factor_of_stage_low",
                                                   "factor_of_stage_high",
                                                   "factor_vs_reference",
                                                   "factor_vs_reference_low",
                                                   "factor_vs_reference_high",
                                                   "error_max",
                                                   "solution_error",
                                                   "error_bar",
                                                   "check",
                                                   "check_error",
                                                   "status",
                                                   "reason"};
  return columns;
}

/// The samples of all stages of a chain, and their records.
class ChainSamples {
public:
  ChainSamples(const ChainStudy& study, const std::vector<Record>& records)
      : study_(study), samples_(samples_of(records)) {}

  const CellSample& of(std::size_t n) const {
    return *std::ranges::find(samples_, chain_cell(n, study_.stages[n]), &CellSample::key);
  }
  /// Ratio of the times of whole runs, stage `base` over stage n, of the same repetition.
  Estimate factor(std::size_t base, std::size_t n) const {
    std::vector<double> ratios = paired_ratios(of(base), of(n));
    for (double& ratio : ratios) ratio *= steps_an_interval(base) / steps_an_interval(n);
    return estimate(ratios);
  }

private:
  double steps_an_interval(std::size_t n) const {
    return double(study_.stages[n].steps_an_interval);
  }
  const ChainStudy& study_;
  const std::vector<CellSample> samples_;
};

double steps_of(const ChainStudy& study, const ChainStage& stage) {
  return double(stage.steps_an_interval) * study.saved_times;
}

/// What a stage is, and its error.
Record stage_record(const ChainStudy& study, std::size_t n, const CellSample& sample,
                    ChainErrors& errors) {
  const ChainStage& stage = study.stages[n];
  return {{"experiment", study.name},
          {"scale", study.scale},
          {"stage", fmt::format("{}", n)},
          {"label", stage.label},
          {"scene", study.scene},
          {"set", set_text(study.set)},
          {"variant", stage.variant},
          {"threads", fmt::format("{}", stage.threads)},
          {"model", std::string(name(stage.model))},
          {"precision", std::string(name(stage.precision))},
          {"integrator", stage.integrator},
          {"dt_s", text_in(sample.last, "dt_s")},
          {"end_time_s", number_text(study.end_time)},
          {"steps", number_text(steps_of(study, stage))},
          {"timed_steps", text_in(sample.last, "steps")},
          {"repetitions", fmt::format("{}", sample.repetitions.size())},
          {"contaminated", fmt::format("{}", sample.contaminated)},
          {"error_max", number_text(errors.of(stage))},
          {"solution_error", number_text(errors.of_solution())},
          {"error_bar", number_text(study.bar)},
          {"check", sample.check()},
          {"check_error", number_text(sample.check_error())},
          {"status", sample.status()},
          {"reason", text_in(sample.last, "reason")}};
}

/// Its time, scaled to the steps of the whole chain if it ran fewer.
void put_time(const CellSample& sample, double steps, Record& row) {
  std::vector<double> walls;
  for (const auto& [repetition, step_s] : sample.step_s()) walls.push_back(step_s * steps);
  const Estimate wall = estimate(walls);
  const bool is_whole = number_in(sample.last, "steps") >= steps;
  row[is_whole ? "measured_wall_s" : "extrapolated_wall_s"] = number_text(wall.median);
  if (!is_whole || !wall.interval) return;
  row["measured_wall_low_s"] = number_text(wall.interval->low);
  row["measured_wall_high_s"] = number_text(wall.interval->high);
}

/// No factor over a base that is wrong, or of threads that share a core.
void put_factors(const ChainSamples& samples, std::size_t n, Record& row) {
  const auto is_right = [&](std::size_t k) { return samples.of(k).status() == "ok"; };
  if (!is_right(n) || !is_right(0) || samples.of(n).is_oversubscribed()) return;
  put_interval(row, "factor_vs_reference", samples.factor(0, n));
  if (n > 0 && is_right(n - 1)) put_interval(row, "factor_of_stage", samples.factor(n - 1, n));
}

} // namespace

std::string chain_cell(std::size_t n, const ChainStage& stage) {
  return fmt::format("{} {} {} t{} {}", n, stage.label, stage.variant, stage.threads,
                     numerics_of(stage));
}

Table chain_table(const ChainStudy& study, const std::vector<Record>& records,
                  ChainErrors& errors) {
  const ChainSamples samples(study, records);
  Table table{chain_columns(), {}};
  for (std::size_t n = 0; n < study.stages.size(); ++n) {
    Record row = stage_record(study, n, samples.of(n), errors);
    put_time(samples.of(n), steps_of(study, study.stages[n]), row);
    put_factors(samples, n, row);
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string chain_text(const ChainStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows)
    rows.push_back({text_in(row, "label"), text_in(row, "variant"), text_in(row, "threads"),
                    text_in(row, "model"), text_in(row, "precision"), text_in(row, "integrator"),
                    shown(row, "dt_s", "{:.3g}"), shown(row, "factor_of_stage", "{:.2f}"),
                    shown(row, "factor_vs_reference", "{:.1f}"),
                    row.contains("factor_vs_reference_low")
                        ? fmt::format("[{}, {}]", shown(row, "factor_vs_reference_low", "{:.1f}"),
                                      shown(row, "factor_vs_reference_high", "{:.1f}"))
                        : "",
                    shown(row, "error_max", "{:.1e}"), text_in(row, "status")});
  return fmt::format("{} ({})\n{}Bar of the error: {:.2g}.", study.title, study.name,
                     text_table({"stage", "variant", "threads", "model", "precision", "integrator",
                                 "dt [s]", "factor", "in all", "interval", "error", "status"},
                                rows),
                     study.bar);
}

} // namespace dss
