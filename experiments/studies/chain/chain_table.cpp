#include "experiments/studies/chain/chain_table.hpp"
#include "experiments/base/statistics.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/samples.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

/// Ratios of the times of whole runs, base over stage, of the same repetition.
Estimate factor_over(const CellSample& base, double base_steps, const CellSample& link,
                     double link_steps) {
  std::vector<double> ratios = paired_ratios(base, link);
  for (double& ratio : ratios) ratio *= base_steps / link_steps;
  return estimate(ratios);
}

} // namespace

std::string chain_cell(std::size_t link, const ChainLink& one) {
  return fmt::format("{} {} {} t{} {}", link, one.label, one.variant, one.threads,
                     numerics_of(one));
}

Table chain_table(const ChainStudy& study, const std::vector<Record>& records,
                  ChainErrors& errors) {
  Table table{{"experiment",
               "scale",
               "link",
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
               "factor_of_link",
               "factor_of_link_low",
               "factor_of_link_high",
               "factor_vs_reference",
               "factor_vs_reference_low",
               "factor_vs_reference_high",
               "error_max",
               "solution_error",
               "error_bar",
               "check",
               "check_error",
               "status",
               "reason"},
              {}};
  const std::vector<CellSample> samples = samples_of(records);
  const auto sample_of = [&](std::size_t link) -> const CellSample& {
    return *std::ranges::find(samples, chain_cell(link, study.links[link]), &CellSample::key);
  };
  for (std::size_t n = 0; n < study.links.size(); ++n) {
    const ChainLink& link = study.links[n];
    const CellSample& sample = sample_of(n);
    const double steps = double(link.steps_an_interval) * study.saved_times;
    std::vector<double> walls;
    for (const auto& [repetition, step_s] : sample.step_s()) walls.push_back(step_s * steps);
    const Estimate wall = estimate(walls);
    Record row{{"experiment", study.name},
               {"scale", study.scale},
               {"link", fmt::format("{}", n)},
               {"label", link.label},
               {"scene", study.scene},
               {"set", set_text(study.set)},
               {"variant", link.variant},
               {"threads", fmt::format("{}", link.threads)},
               {"model", std::string(name(link.model))},
               {"precision", std::string(name(link.precision))},
               {"integrator", link.integrator},
               {"dt_s", text_in(sample.last, "dt_s")},
               {"end_time_s", number_text(study.end_time)},
               {"steps", number_text(steps)},
               {"timed_steps", text_in(sample.last, "steps")},
               {"repetitions", fmt::format("{}", walls.size())},
               {"contaminated", fmt::format("{}", sample.contaminated)},
               {"error_max", number_text(errors.of(link))},
               {"solution_error", number_text(errors.of_solution())},
               {"error_bar", number_text(study.bar)},
               {"check", sample.check()},
               {"check_error", number_text(sample.check_error())},
               {"status", sample.status()},
               {"reason", text_in(sample.last, "reason")}};
    const bool is_whole =
        number_in(sample.last, "steps") >= steps; // of fewer steps the time is not a measured one
    row[is_whole ? "measured_wall_s" : "extrapolated_wall_s"] = number_text(wall.median);
    if (is_whole && wall.interval) {
      row["measured_wall_low_s"] = number_text(wall.interval->low);
      row["measured_wall_high_s"] = number_text(wall.interval->high);
    }
    // No factor over a base that is wrong, or of threads that share a core.
    if (row["status"] == "ok" && sample_of(0).status() == "ok" && !sample.is_oversubscribed()) {
      const auto steps_of = [&](std::size_t k) { return double(study.links[k].steps_an_interval); };
      put_interval(row, "factor_vs_reference",
                   factor_over(sample_of(0), steps_of(0), sample, steps_of(n)));
      if (n > 0 && sample_of(n - 1).status() == "ok")
        put_interval(row, "factor_of_link",
                     factor_over(sample_of(n - 1), steps_of(n - 1), sample, steps_of(n)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string chain_text(const ChainStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows)
    rows.push_back({text_in(row, "label"), text_in(row, "variant"), text_in(row, "threads"),
                    text_in(row, "model"), text_in(row, "precision"), text_in(row, "integrator"),
                    shown(row, "dt_s", "{:.3g}"), shown(row, "factor_of_link", "{:.2f}"),
                    shown(row, "factor_vs_reference", "{:.1f}"),
                    row.contains("factor_vs_reference_low")
                        ? fmt::format("[{}, {}]", shown(row, "factor_vs_reference_low", "{:.1f}"),
                                      shown(row, "factor_vs_reference_high", "{:.1f}"))
                        : "",
                    shown(row, "error_max", "{:.1e}"), text_in(row, "status")});
  return fmt::format("{} ({})\n{}Bar of the error: {:.2g}.", study.title, study.name,
                     text_table({"link", "variant", "threads", "model", "precision", "integrator",
                                 "dt [s]", "factor", "in all", "interval", "error", "status"},
                                rows),
                     study.bar);
}

} // namespace dss
