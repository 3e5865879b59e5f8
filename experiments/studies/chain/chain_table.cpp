#include "experiments/studies/chain/chain_table.hpp"
#include "experiments/base/statistics.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/samples.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace dss {
namespace {

const std::vector<std::string>& chain_columns() {
  static const std::vector<std::string> columns = {"experiment",
                                                   "scale",
                                                   "stage",
                                                   "role",
                                                   "label",
                                                   "scene",
                                                   "set",
                                                   "variant",
                                                   "threads",
                                                   "model",
                                                   "precision",
                                                   "integrator",
                                                   "smoothing",
                                                   "dt_s",
                                                   "end_time_s",
                                                   "steps",
                                                   "timed_steps",
                                                   "repetitions",
                                                   "contaminated",
                                                   "wall_s",
                                                   "wall_low_s",
                                                   "wall_high_s",
                                                   "scaled",
                                                   "base",
                                                   "factor_of_stage",
                                                   "factor_of_stage_low",
                                                   "factor_of_stage_high",
                                                   "factor_vs_base",
                                                   "factor_vs_base_low",
                                                   "factor_vs_base_high",
                                                   "error_max",
                                                   "error_until_s",
                                                   "solution_error",
                                                   "oracle_error",
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
      : stages_(study.timed()), samples_(samples_of(records)) {}

  const CellSample& of(std::size_t n) const {
    return *std::ranges::find(samples_, chain_cell(n, stages_[n]), &CellSample::key);
  }
  /// Ratio of the times of whole runs, stage `base` over stage n, of the same repetition. Empty
  /// with too few repetitions for an interval.
  std::optional<Estimate> factor(std::size_t base, std::size_t n) const {
    std::vector<double> ratios = paired_ratios(of(base), of(n));
    if (ratios.size() < interval_samples) return {};
    for (double& ratio : ratios) ratio *= steps_an_interval(base) / steps_an_interval(n);
    return estimate(ratios);
  }

private:
  double steps_an_interval(std::size_t n) const { return double(stages_[n].steps_an_interval); }
  const std::vector<ChainStage> stages_;
  const std::vector<CellSample> samples_;
};

double steps_of(const ChainStudy& study, const ChainStage& stage) {
  return double(stage.steps_an_interval) * study.saved_times;
}

/// What a stage is, and its error.
Record stage_record(const ChainStudy& study, std::size_t n, const ChainStage& stage,
                    const CellSample& sample, const ChainErrors& errors) {
  const StageError error = errors.of(stage);
  return {{"experiment", study.name},
          {"scale", study.scale},
          {"stage", fmt::format("{}", n)},
          {"role", n < study.stages.size() ? "stage" : "neighbour"},
          {"label", stage.label},
          {"scene", study.scene},
          {"set", set_text(study.set)},
          {"variant", stage.variant},
          {"threads", fmt::format("{}", stage.threads)},
          {"model", std::string(name(stage.model))},
          {"precision", std::string(name(stage.precision))},
          {"integrator", stage.integrator},
          {"smoothing", number_text(method_of(stage).is_staggered() ? method_of(stage).smoothing
                                                                    : std::nan(""))},
          {"dt_s", text_in(sample.last, "dt_s")},
          {"end_time_s", number_text(study.end_time)},
          {"steps", number_text(steps_of(study, stage))},
          {"timed_steps", text_in(sample.last, "steps")},
          {"repetitions", fmt::format("{}", sample.repetitions.size())},
          {"contaminated", fmt::format("{}", sample.contaminated)},
          {"base", study.stages[0].variant},
          {"error_max", number_text(error.largest)},
          {"error_until_s", number_text(error.until_s)},
          {"solution_error", number_text(errors.of_solution())},
          {"oracle_error", number_text(errors.of_oracle())},
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
  row["wall_s"] = number_text(wall.median);
  row["scaled"] = number_in(sample.last, "steps") < steps ? "yes" : "no";
  if (!wall.interval) return;
  row["wall_low_s"] = number_text(wall.interval->low);
  row["wall_high_s"] = number_text(wall.interval->high);
}

/// No factor over a base that is wrong, or of threads that share a core. The factor of a neighbour
/// is that over its stage.
void put_factors(const ChainStudy& study, const ChainSamples& samples, std::size_t n, Record& row) {
  const auto is_right = [&](std::size_t k) { return samples.of(k).status() == "ok"; };
  if (!is_right(n) || !is_right(0) || samples.of(n).is_oversubscribed()) return;
  if (const auto factor = samples.factor(0, n)) put_interval(row, "factor_vs_base", *factor);
  const std::size_t stages = study.stages.size();
  if (n == 0) return;
  const std::size_t before = n < stages ? n - 1 : study.neighbours[n - stages].of;
  if (!is_right(before)) return;
  if (const auto factor = samples.factor(before, n)) put_interval(row, "factor_of_stage", *factor);
}

} // namespace

std::string chain_cell(std::size_t n, const ChainStage& stage) {
  return fmt::format("{} {} {} t{} {}", n, stage.label, stage.variant, stage.threads,
                     numerics_of(stage));
}

Table chain_table(const ChainStudy& study, const std::vector<Record>& records,
                  const ChainErrors& errors) {
  const ChainSamples samples(study, records);
  const std::vector<ChainStage> stages = study.timed();
  Table table{chain_columns(), {}};
  for (std::size_t n = 0; n < stages.size(); ++n) {
    Record row = stage_record(study, n, stages[n], samples.of(n), errors);
    put_time(samples.of(n), steps_of(study, stages[n]), row);
    put_factors(study, samples, n, row);
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string chain_text(const ChainStudy& study, const Table& table) {
  const auto interval = [](const Record& row, const std::string& column, const char* form) {
    return fmt::format("[{}, {}]", shown(row, column + "_low", form),
                       shown(row, column + "_high", form));
  };
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows)
    rows.push_back(
        {(text_in(row, "role") == "stage" ? "" : "beside: ") + text_in(row, "label"),
         text_in(row, "variant"), text_in(row, "threads"), text_in(row, "model"),
         text_in(row, "precision"), text_in(row, "integrator"), shown(row, "dt_s", "{:.3g}"),
         shown(row, "factor_of_stage", "{:.2f}"), shown(row, "factor_vs_base", "{:.1f}"),
         text_in(row, "factor_vs_base").empty() ? "" : interval(row, "factor_vs_base", "{:.1f}"),
         shown(row, "error_max", "{:.1e}"), shown(row, "error_until_s", "{:.3g}"),
         text_in(row, "status")});
  return fmt::format(
      "{} ({})\n{}Factors are over {}, and of whole runs. Bar of the error: {:.2g}. "
      "Fewer than {} repetitions give no factor.\n",
      study.title, study.name,
      text_table({"stage", "variant", "threads", "model", "precision", "integrator", "dt [s]",
                  "factor", "in all", "interval", "error", "until [s]", "status"},
                 rows),
      study.stages[0].variant, study.bar, interval_samples);
}

} // namespace dss
