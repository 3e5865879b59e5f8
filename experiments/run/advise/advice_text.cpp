#include "experiments/run/advise/advice_text.hpp"
#include "experiments/base/text_table.hpp"

#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

using AdviceJson = nlohmann::ordered_json;

std::string time_text(double time_s) {
  if (!std::isfinite(time_s)) return "";
  return time_s < 1e-3 ? fmt::format("{:.3g} us", 1e6 * time_s)
         : time_s < 1  ? fmt::format("{:.3g} ms", 1e3 * time_s)
                       : fmt::format("{:.3g} s", time_s);
}

std::string step_text(const Workbench& bench, const Configuration& of) {
  return of.rtol ? fmt::format("rtol {:.2g}", *of.rtol) : fmt::format("{:.4g}", bench.dt(of));
}

std::vector<std::string> row_of(const Workbench& bench, const std::string& what,
                                const Configuration& of, const std::string& error, double time_s,
                                const std::string& remark) {
  return {what,
          std::string(name(of.model)),
          std::string(of.method->name),
          std::string(name(of.precision)),
          step_text(bench, of),
          of.rtol ? "" : fmt::format("{}", bench.steps(of)),
          fmt::format("{} x {}", of.variant, of.threads),
          error,
          time_text(time_s),
          remark};
}

const std::vector<std::string> advice_head{"",         "model", "integrator",        "precision",
                                           "step [s]", "steps", "variant x threads", "error",
                                           "time",     ""};

AdviceJson number_or_null(double value, bool is_there = true) {
  return is_there && std::isfinite(value) ? AdviceJson(value) : AdviceJson();
}

AdviceJson configuration_json(const Workbench& bench, const Configuration& of) {
  return {
      {"model", name(of.model)},         {"integrator", std::string(of.method->name)},
      {"precision", name(of.precision)}, {"dt_s", bench.dt(of)},
      {"steps", bench.steps(of)},        {"rtol", of.rtol ? AdviceJson(*of.rtol) : AdviceJson()},
      {"variant", of.variant},           {"threads", of.threads}};
}

AdviceJson candidate_json(const Workbench& bench, const Candidate& candidate) {
  AdviceJson json = configuration_json(bench, candidate.configuration);
  json["status"] = name(candidate.status);
  json["error"] = number_or_null(candidate.error, candidate.error > 0);
  json["time_s"] = number_or_null(candidate.time_s);
  json["is_timed"] = candidate.is_timed;
  json["reason"] = candidate.reason;
  return json;
}

AdviceJson reference_json(const Workbench& bench, const ReferenceRun& reference) {
  AdviceJson levels = AdviceJson::array();
  for (const ReferenceLevel& level : reference.levels)
    levels.push_back({{"steps", level.steps_between * bench.times().count},
                      {"change", number_or_null(level.change, level.change > 0)},
                      {"time_s", level.wall_s}});
  AdviceJson json = {{"error", reference.error}, {"levels", levels}};
  if (!reference.levels.empty()) json.update(configuration_json(bench, reference.configuration));
  return json;
}

} // namespace

std::string describe(const Workbench& bench, const Candidate& candidate) {
  const Configuration& of = candidate.configuration;
  return fmt::format("{}, {}, {}, {}: error {:.2g}, {}", name(of.model), of.method->name,
                     name(of.precision),
                     of.rtol ? fmt::format("rtol {:.2g}", *of.rtol)
                             : fmt::format("{} steps of {:.4g} s", bench.steps(of), bench.dt(of)),
                     candidate.error, time_text(candidate.time_s));
}

std::string command_line(const AdvisedScene& scene, const Workbench& bench,
                         const Configuration& of) {
  return fmt::format("dssbench run {}{} --model {} --integrator {} --precision {}{} --dt {:.17g} "
                     "--steps {} --variant {} "
                     "--threads {}",
                     scene.scene, scene.set, name(of.model), of.method->name, name(of.precision),
                     of.rtol ? fmt::format(" --rtol {:.4g}", *of.rtol) : "", bench.dt(of),
                     bench.steps(of), of.variant, of.threads);
}

std::string advice_text(const AdvisedScene& scene, const AdviseRequest& request,
                        const Workbench& bench, const Advice& advice, bool is_verbose) {
  const PaperRun& paper = advice.paper;
  std::string text = fmt::format("{}: {} elements to t = {:g} s; {} within {:g}: {}\n", scene.name,
                                 scene.elements, bench.times().end, name(request.quantity),
                                 request.tolerance, measure_of(request.quantity));
  std::vector<std::vector<std::string>> rows;
  if (advice.failure.empty())
    rows.push_back(row_of(bench, "advised", advice.chosen.configuration,
                          fmt::format("{:.2g}", advice.error_estimate), advice.chosen.time_s,
                          advice.chosen.is_timed ? "" : "predicted"));
  rows.push_back(row_of(bench, "the paper's", paper.configuration,
                        paper.error ? fmt::format("{:.2g}", *paper.error) : "", paper.time_s,
                        paper.reason.empty() ? paper.is_timed ? "" : "predicted" : paper.reason));
  for (const Candidate& other : advice.candidates)
    if (is_verbose)
      rows.push_back(row_of(bench, std::string(name(other.status)), other.configuration,
                            other.error > 0 ? fmt::format("{:.2g}", other.error) : "", other.time_s,
                            other.reason));
  text += text_table(advice_head, rows);
  for (const auto& [model, reason] : advice.left_out)
    if (is_verbose) text += fmt::format("model {} left out: {}\n", name(model), reason);
  if (advice.failure.empty())
    text += fmt::format("{:.3g} times as fast as the paper's configuration. Errors are against {} "
                        "steps of dopri5 (model {}, "
                        "f64), themselves within {:.1e}.\n{}\n",
                        paper.time_s / advice.chosen.time_s,
                        bench.steps(advice.reference.configuration),
                        name(advice.reference.configuration.model), advice.reference.error,
                        command_line(scene, bench, advice.chosen.configuration));
  return text + fmt::format("Trials took {}.\n", time_text(advice.spent_s));
}

nlohmann::ordered_json advice_json(const AdvisedScene& scene, const AdviseRequest& request,
                                   const Workbench& bench, const Advice& advice) {
  AdviceJson json = {
      {"scene", scene.name},
      {"elements", scene.elements},
      {"quantity", name(request.quantity)},
      {"measure", measure_of(request.quantity)},
      {"tolerance", request.tolerance},
      {"end_time_s", bench.times().end},
      {"saved_times", bench.times().count},
      {"status", advice.failure.empty() ? "ok" : "failed"},
      {"reason", advice.failure},
      {"least_tolerance", number_or_null(advice.least_tolerance, advice.least_tolerance > 0)}};
  if (advice.failure.empty()) {
    json["chosen"] = configuration_json(bench, advice.chosen.configuration);
    json["chosen"]["error_estimate"] = advice.error_estimate;
    json["chosen"]["time_s"] = advice.chosen.time_s;
    json["chosen"]["command"] = command_line(scene, bench, advice.chosen.configuration);
    json["speedup_over_paper"] = advice.paper.time_s / advice.chosen.time_s;
  }
  json["paper"] = configuration_json(bench, advice.paper.configuration);
  json["paper"]["error"] = advice.paper.error ? AdviceJson(*advice.paper.error) : AdviceJson();
  json["paper"]["time_s"] = number_or_null(advice.paper.time_s);
  json["paper"]["is_timed"] = advice.paper.is_timed;
  json["paper"]["reason"] = advice.paper.reason;
  json["reference"] = reference_json(bench, advice.reference);
  json["spent_s"] = advice.spent_s;
  json["others"] = AdviceJson::array();
  for (const Candidate& other : advice.candidates)
    json["others"].push_back(candidate_json(bench, other));
  json["left_out"] = AdviceJson::object();
  for (const auto& [model, reason] : advice.left_out)
    json["left_out"][std::string(name(model))] = reason;
  return json;
}

std::string grid_text(const std::string& parameter, const GridAdvice& grid) {
  std::vector<std::vector<std::string>> rows;
  for (const GridRun& run : grid.runs)
    rows.push_back({fmt::format("{}", run.value), fmt::format("{}", run.elements),
                    fmt::format("{:.2g}", run.error), run.value == grid.value ? "advised" : ""});
  return fmt::format("grids, observed order {:.2f}:\n{}", grid.order,
                     text_table({parameter, "elements", "error in space", ""}, rows));
}

nlohmann::ordered_json grid_json(const std::string& parameter, const GridAdvice& grid) {
  AdviceJson runs = AdviceJson::array();
  for (const GridRun& run : grid.runs)
    runs.push_back({{"value", run.value}, {"elements", run.elements}, {"error", run.error}});
  return {{"parameter", parameter},
          {"value", grid.value},
          {"error", grid.error},
          {"observed_order", grid.order},
          {"grids", runs}};
}

} // namespace dss
