#include "experiments/runner/chain/chain_study.hpp"
#include "experiments/runner/circumstances.hpp"
#include "experiments/runner/context.hpp"
#include "experiments/runner/experiment.hpp"
#include "experiments/runner/progress.hpp"
#include "experiments/runner/samples.hpp"
#include "experiments/runner/statics/statics_study.hpp"
#include "experiments/runner/statistics.hpp"
#include "experiments/runner/text_table.hpp"
#include "experiments/runner/usage.hpp"
#include "solver/model/fields.hpp"
#include "solver/numerics/denormals.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "variants/loader.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <set>

namespace dss {
namespace {

constexpr long checked_steps = 10;
constexpr double state_tolerance = 1e-9, single_state_tolerance = 1e-4;

/// A link's executor, from rest on.
class LinkRun {
public:
  LinkRun(const ChainStudy& study, const Scene& scene, const ChainLink& link)
      : scene_(scene), method_(*find_method(link.integrator)),
        dt_(study.end_time / double(study.saved_times) / double(link.steps_an_interval)),
        executor_(
            load_variant(link.variant).create({scene.problem, method_, link.model, link.precision, dt_, link.threads})),
        end_(link.steps_an_interval * study.saved_times), start_(state()) {}
  double dt() const { return dt_; }
  /// From where it is, or from the start where the run would pass its end.
  void advance(long steps) {
    if (done_ > 0 && done_ + steps > end_) {
      executor_->write(0, start_);
      done_ = 0;
    }
    const std::vector<double> signals = signal_rows(scene_.problem, method_, dt_, done_, steps);
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = executor_->advance(steps, signals);
    wall_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!outcome.is_finite)
      throw InputError(fmt::format("chain: {} at dt = {:g} s: {} in step {}", method_.name, dt_, outcome.what,
                                   done_ + outcome.step));
    done_ += steps;
  }
  double wall_s() const { return wall_s_; } ///< of the last advance [s]
  std::vector<double> state() {
    std::vector<double> fields(scene_.problem.lattice.element_count * field_count);
    executor_->read(0, fields);
    return fields;
  }

private:
  const Scene& scene_;
  const Method& method_;
  double dt_, wall_s_ = 0;
  long done_ = 0;
  std::unique_ptr<Executor> executor_;
  const long end_;
  const std::vector<double> start_;
};

using States = std::vector<std::vector<double>>; ///< at the saved times

States states_of(const ChainStudy& study, const Scene& scene, ChainLink link) {
  link.variant = load_variant("auto").name;
  link.threads = usable_cores();
  LinkRun run(study, scene, link);
  States states;
  for (int time = 0; time < study.saved_times; ++time) {
    run.advance(link.steps_an_interval);
    states.push_back(run.state());
  }
  return states;
}

/// Largest difference of displacements at any saved time over the largest displacement at any.
double largest_error(const States& states, const States& solution) {
  double difference = 0, largest = 0;
  for (std::size_t time = 0; time < states.size(); ++time)
    for (std::size_t k = 0; k < states[time].size(); ++k) {
      if (int(k % field_count) > uz) continue;
      const double error = std::abs(states[time][k] - solution[time][k]);
      difference = std::isnan(error) ? error : std::max(difference, error);
      largest = std::max(largest, std::abs(solution[time][k]));
    }
  return difference / largest;
}

std::string numerics_of(const ChainLink& link) {
  return fmt::format("{} {} {} {}", name(link.model), name(link.precision), link.integrator, link.steps_an_interval);
}

/// Errors of whole runs against the solution, by numerics; each computed by the fastest variant.
class ChainErrors {
public:
  ChainErrors(const ChainStudy& study, const Scene& scene, Progress& progress)
      : study_(study), scene_(scene), progress_(progress), solution_(states_of(study, scene, study.solution)) {
    ChainLink coarse = study.solution;
    coarse.steps_an_interval /= 2;
    // Two steps of a method of order p differ by 2^p - 1 errors of the finer.
    solution_error_ = largest_error(states_of(study, scene, coarse), solution_) /
                      (std::pow(2.0, find_method(coarse.integrator)->order) - 1);
    progress_.note(fmt::format("chain: solution with {} steps, its own error {:.1e}",
                               study.solution.steps_an_interval * study.saved_times, solution_error_));
  }
  double of_solution() const { return solution_error_; }
  double of(const ChainLink& link) {
    const auto [place, is_new] = errors_.try_emplace(numerics_of(link));
    if (is_new) {
      place->second = largest_error(states_of(study_, scene_, link), solution_);
      progress_.note(fmt::format("chain: {}: error {:.2e}", place->first, place->second));
    }
    return place->second;
  }

private:
  const ChainStudy& study_;
  const Scene& scene_;
  Progress& progress_;
  const States solution_;
  double solution_error_ = 0;
  std::map<std::string, double> errors_;
};

/// Difference of a link's state after a few steps from what it must be: that of the oracle's variant for spatial f64, else of the fastest one.
double state_difference(const ChainStudy& study, const Scene& scene, const ChainLink& link) {
  ChainLink right = link;
  right.variant = link.model == Model::spatial && link.precision == Precision::f64 ? "reference" : "scalar";
  right.threads = 1;
  LinkRun run(study, scene, link), expected(study, scene, right);
  run.advance(checked_steps);
  expected.advance(checked_steps);
  return displacement_difference(run.state(), expected.state());
}

const std::vector<std::string>& raw_chain_columns() {
  static const std::vector<std::string> columns = {
      "experiment",   "cell",       "link",        "label",           "variant", "threads", "cores",   "model",
      "precision",    "integrator", "dt_s",        "repetition",      "steps",   "wall_s",  "cpu_s",   "sample_s",
      "contaminated", "check",      "check_error", "check_tolerance", "status",  "reason",  "time_utc"};
  return columns;
}

std::string cell_of(std::size_t link, const ChainLink& one) {
  return fmt::format("{} {} {} t{} {}", link, one.label, one.variant, one.threads, numerics_of(one));
}

/// Times all links in turn, as often as the study says.
void time_links(const ChainStudy& study, const Scene& scene, RecordFile& records, Progress& progress) {
  std::set<std::pair<std::string, std::string>> present;
  for (const Record& record : records.present())
    present.emplace(text_in(record, "cell"), text_in(record, "repetition"));
  std::vector<std::unique_ptr<LinkRun>> runs;
  std::vector<long> steps;
  std::vector<double> differences;
  for (const ChainLink& link : study.links) {
    differences.push_back(state_difference(study, scene, link));
    runs.push_back(std::make_unique<LinkRun>(study, scene, link));
    long count = 1;
    for (runs.back()->advance(count); runs.back()->wall_s() < study.sample_s; runs.back()->advance(count))
      count = std::max(count + 1, long(double(count) * std::min(8.0, 1.2 * study.sample_s / runs.back()->wall_s())));
    steps.push_back(count);
  }
  double done = 0;
  for (int repetition = 0; repetition < study.repetitions; ++repetition)
    for (std::size_t n = 0; n < runs.size(); ++n) {
      const ChainLink& link = study.links[n];
      progress.show(done++, double(study.repetitions) * double(runs.size()), link.label);
      if (present.contains({cell_of(n, link), fmt::format("{}", repetition)})) continue;
      const UsageMeter meter;
      runs[n]->advance(steps[n]);
      const Usage usage = meter.read();
      const double wall_s = runs[n]->wall_s(),
                   tolerance = link.precision == Precision::f64 ? state_tolerance : single_state_tolerance;
      const bool is_right = differences[n] <= tolerance;
      records.append({{"experiment", study.name},
                      {"cell", cell_of(n, link)},
                      {"link", fmt::format("{}", n)},
                      {"label", link.label},
                      {"variant", link.variant},
                      {"threads", fmt::format("{}", link.threads)},
                      {"cores", fmt::format("{}", usable_cores())},
                      {"model", std::string(name(link.model))},
                      {"precision", std::string(name(link.precision))},
                      {"integrator", link.integrator},
                      {"dt_s", number_text(runs[n]->dt())},
                      {"repetition", fmt::format("{}", repetition)},
                      {"steps", fmt::format("{}", steps[n])},
                      {"wall_s", number_text(wall_s)},
                      {"cpu_s", number_text(usage.cpu_s)},
                      {"sample_s", number_text(wall_s)},
                      {"contaminated", is_contaminated(usage, wall_s, link.threads) ? "true" : "false"},
                      {"check", is_right ? "passed" : "failed"},
                      {"check_error", number_text(differences[n])},
                      {"check_tolerance", number_text(tolerance)},
                      {"status", is_right ? "ok" : "wrong"},
                      {"reason", is_right ? "" : "its state is not that of the plain code"},
                      {"time_utc", measurement_time()}});
    }
}

/// Ratios of whole runs' times, base over link, of the same repetition.
Estimate factor_over(const CellSample& base, double base_steps, const CellSample& link, double link_steps) {
  std::vector<double> ratios = paired_ratios(base, link);
  for (double& ratio : ratios) ratio *= base_steps / link_steps;
  return estimate(ratios);
}

void put_factor(Record& row, const std::string& column, const Estimate& factor) {
  row[column] = number_text(factor.median);
  if (!factor.interval) return;
  row[column + "_low"] = number_text(factor.interval->low);
  row[column + "_high"] = number_text(factor.interval->high);
}

Table chain_table(const ChainStudy& study, const std::vector<Record>& records, ChainErrors& errors) {
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
    return *std::ranges::find(samples, cell_of(link, study.links[link]), &CellSample::key);
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
    const bool is_whole = number_in(sample.last, "steps") >= steps; // of fewer steps the time is not a measured one
    row[is_whole ? "measured_wall_s" : "extrapolated_wall_s"] = number_text(wall.median);
    if (is_whole && wall.interval) {
      row["measured_wall_low_s"] = number_text(wall.interval->low);
      row["measured_wall_high_s"] = number_text(wall.interval->high);
    }
    if (row["status"] == "ok") {
      const auto steps_of = [&](std::size_t k) { return double(study.links[k].steps_an_interval); };
      put_factor(row, "factor_vs_reference", factor_over(sample_of(0), steps_of(0), sample, steps_of(n)));
      if (n > 0) put_factor(row, "factor_of_link", factor_over(sample_of(n - 1), steps_of(n - 1), sample, steps_of(n)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string chain_text(const ChainStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const Record& row : table.rows)
    rows.push_back({text_in(row, "label"), text_in(row, "variant"), text_in(row, "threads"), text_in(row, "model"),
                    text_in(row, "precision"), text_in(row, "integrator"), shown(row, "dt_s", "{:.3g}"),
                    shown(row, "factor_of_link", "{:.2f}"), shown(row, "factor_vs_reference", "{:.1f}"),
                    row.contains("factor_vs_reference_low")
                        ? fmt::format("[{}, {}]", shown(row, "factor_vs_reference_low", "{:.1f}"),
                                      shown(row, "factor_vs_reference_high", "{:.1f}"))
                        : "",
                    shown(row, "error_max", "{:.1e}"), text_in(row, "status")});
  return fmt::format("{} ({})\n{}Bar of the error: {:.2g}.", study.title, study.name,
                     text_table({"link", "variant", "threads", "model", "precision", "integrator", "dt [s]", "factor",
                                 "in all", "interval", "error", "status"},
                                rows),
                     study.bar);
}

} // namespace

bool run_chain(const ChainStudy& study, const std::string& directory, bool resumes) {
  const ExperimentPaths paths = experiment_paths(directory, study.name);
  std::error_code ignored;
  for (const std::string& path : {paths.raw, paths.table})
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  Cell cell;
  cell.scene = study.scene, cell.set = study.set;
  Study circumstances;
  circumstances.name = study.name, circumstances.title = study.title, circumstances.scale.name = study.scale;
  circumstances.cells = {cell};
  if (resumes && std::filesystem::exists(paths.raw)) require_same_circumstances(paths.context, circumstances);
  flush_denormals();
  Progress progress;
  const Scene scene = load_scene(study.scene, study.set);
  RecordFile records(paths.raw, raw_chain_columns(), resumes);
  if (records.present().empty())
    write_circumstances(paths.context, measurement_context(), circumstances);
  else
    note_resumption(paths.context);
  time_links(study, scene, records, progress);
  ChainErrors errors(study, scene, progress);
  const Table table = chain_table(study, read_csv(paths.raw).rows, errors);
  write_csv(paths.table, table);
  fmt::print("{}\nTable: {}\n", chain_text(study, table), paths.table);
  const bool is_right =
      std::ranges::all_of(table.rows, [](const Record& row) { return text_in(row, "status") == "ok"; });
  return is_right && number_in(table.rows.back(), "error_max") <= study.bar;
}

} // namespace dss
