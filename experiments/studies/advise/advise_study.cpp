#include "experiments/studies/advise/advise_study.hpp"
#include "experiments/base/parallel.hpp"
#include "experiments/base/statistics.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/circumstances.hpp"
#include "experiments/run/advise/advise.hpp"
#include "experiments/run/advise/first_steps.hpp"
#include "experiments/run/advise/step_costs.hpp"
#include "experiments/run/plan/exponential.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/studies/advise/brute_force.hpp"
#include "solver/cores.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <mutex>

namespace dss {
namespace {

/// number of runs that are timed beside the advised run
constexpr std::size_t contenders_of_tolerance = 5;
constexpr double contender_share = 1.5; ///< relative to the cheapest time in the search
/// variants and threads up to this multiple of the fastest time are tried
constexpr double near_target = 1.3;
constexpr int duel_rounds = 9;
constexpr double duel_sample_s = 4e-3;

/// Reads a solution from its file, or computes and writes it.
Solution kept_solution(const AdviseStudy& study, const AdviseStudy::Case& of,
                       const std::string& directory,
                       const std::function<void(const std::string&)>& note) {
  const SolutionRule& rule = study.solution;
  const std::string key =
      fmt::format("advise {} {} {}, {} times to {:.17g} s, {}", of.scene, set_text(of.set),
                  scene_digest(of.loaded), of.times.count, of.times.end, rule.key());
  const std::string path =
      fmt::format("{}/{:016x}.solution", directory, std::hash<std::string>{}(key));
  if (std::filesystem::exists(path))
    if (Solution solution = read_solution(path); solution.key == key) return solution;
  Solution solution = find_solution(
      of.loaded.problem, require_stepwise(require_method(rule.integrator)), rule, of.times, note);
  solution.key = key;
  write_solution(path, solution);
  return solution;
}

struct DuelEntry {
  Configuration configuration;
  double error = 0;
  std::vector<double> times_s;
};

/// All rows of one scene.
class CaseRows {
public:
  CaseRows(const AdviseStudy& study, const AdviseStudy::Case& of, const Solution& solution,
           const std::function<void(const std::string&)>& note)
      : study_(study), of_(of), solution_(solution), note_(note),
        bench_(of.loaded.problem, of.times, of.quantity),
        expected_(observed_of(of.loaded.problem, of.quantity, solution.times, solution.states)),
        costs_(bench_, base(), advised_variants(bench_.problem(), {}), usable_cores()) {}

  std::vector<Record> rows() {
    note_(fmt::format("{} {}: trying everything", of_.scene, set_text(of_.set)));
    runs_ = brute_force(bench_, costs_, expected_, study_.tolerances.back());
    std::vector<Record> rows;
    for (const double tolerance : study_.tolerances) rows.push_back(row(tolerance));
    return rows;
  }

private:
  Configuration base() const {
    Configuration configuration;
    configuration.method = find_method("rk4");
    configuration.steps_between = first_steps(of_.loaded.problem, of_.times).at("rk4");
    return configuration;
  }

  Record row(double tolerance) {
    note_(fmt::format("{} {}: advice for {:g}", of_.scene, set_text(of_.set), tolerance));
    AdviseRequest request;
    request.tolerance = tolerance;
    request.quantity = of_.quantity;
    request.most_threads = usable_cores();
    const Advice advice = advise(of_.loaded.problem, of_.times, request);
    Record row = {{"experiment", study_.name},
                  {"scale", study_.scale},
                  {"scene", of_.loaded.name},
                  {"set", set_text(of_.set)},
                  {"elements", fmt::format("{}", of_.loaded.problem.lattice.element_count)},
                  {"quantity", std::string(name(of_.quantity))},
                  {"end_time_s", number_text(of_.times.end)},
                  {"tolerance", number_text(tolerance)},
                  {"solution_error", number_text(solution_.error)},
                  {"paper_wall_s", number_text(advice.paper.time_s)},
                  {"paper_error", advice.paper.error ? number_text(*advice.paper.error) : ""},
                  {"brute_force_runs", fmt::format("{}", runs_.size())},
                  {"advise_s", number_text(advice.spent_s)}};
    if (!advice.failure.empty()) {
      row["status"] = "failed";
      row["reason"] = "nothing was advised: " + advice.failure;
      return row;
    }
    judge(advice, tolerance, row);
    return row;
  }

  void judge(const Advice& advice, double tolerance, Record& row) {
    const Configuration& chosen = advice.chosen.configuration;
    const Observation observation = bench_.run(chosen);
    const double error = bench_.error(expected_, observation.observed);
    describe_in(chosen, "", row);
    row["error_estimate"] = number_text(advice.error_estimate);
    row["true_error"] = number_text(error);
    const bool is_within = observation.failure.empty() && error <= tolerance;
    row["status"] = is_within ? "ok" : "failed";
    if (!is_within)
      row["reason"] = fmt::format("the true error {:.3g} is above the tolerance", error);
    std::vector<DuelEntry> entries = contenders(tolerance);
    const bool has_contenders = !entries.empty(); // false: no run of the search met the tolerance
    std::erase_if(entries, [&](const DuelEntry& entry) { return entry.configuration == chosen; });
    entries.insert(entries.begin(), {chosen, error, {}});
    duel(entries);
    const DuelEntry& cheapest = *std::ranges::min_element(
        entries, {}, [](const DuelEntry& entry) { return median(entry.times_s); });
    std::vector<double> ratios;
    for (std::size_t round = 0; round < cheapest.times_s.size(); ++round)
      ratios.push_back(entries.front().times_s[round] / cheapest.times_s[round]);
    const double ratio = median(ratios);
    row["measured_wall_s"] = number_text(median(entries.front().times_s));
    row["verdict"] = !has_contenders ? "not judged" : ratio <= study_.bar ? "ok" : "slower";
    if (has_contenders) {
      describe_in(cheapest.configuration, "cheapest_", row);
      row["cheapest_true_error"] = number_text(cheapest.error);
      row["cheapest_measured_wall_s"] = number_text(median(cheapest.times_s));
      row["time_over_cheapest"] = number_text(ratio);
    }
    row["speedup_over_paper"] = number_text(advice.paper.time_s / median(entries.front().times_s));
  }

  void describe_in(const Configuration& of, const std::string& prefix, Record& row) const {
    row[prefix + "model"] = name(of.model);
    row[prefix + "integrator"] = of.method->name;
    row[prefix + "precision"] = name(of.precision);
    row[prefix + "dt_s"] = number_text(bench_.dt(of));
    row[prefix + "rtol"] = of.rtol ? number_text(*of.rtol) : "";
    row[prefix + "variant"] = of.variant;
    row[prefix + "threads"] = fmt::format("{}", of.threads);
  }

  /// The cheapest runs whose true error meets the tolerance, each on all variants and threads that
  /// may be the fastest.
  std::vector<DuelEntry> contenders(double tolerance) {
    std::vector<BruteForceRun> meeting;
    for (const BruteForceRun& run : runs_)
      if (run.error <= tolerance) meeting.push_back(run);
    std::ranges::sort(meeting, {}, &BruteForceRun::wall_s);
    std::vector<DuelEntry> entries;
    for (std::size_t n = 0; n < std::min(contenders_of_tolerance, meeting.size()); ++n) {
      if (meeting[n].wall_s > contender_share * meeting[0].wall_s) break;
      for (const Target& target : costs_.near_best(meeting[n].configuration, near_target)) {
        entries.push_back({meeting[n].configuration, meeting[n].error, {}});
        entries.back().configuration.variant = target.variant;
        entries.back().configuration.threads = target.threads;
      }
    }
    return entries;
  }

  void duel(std::vector<DuelEntry>& entries) const {
    for (int round = 0; round < duel_rounds; ++round)
      for (DuelEntry& entry : entries)
        entry.times_s.push_back(bench_.run_time(entry.configuration, duel_sample_s));
  }

  const AdviseStudy& study_;
  const AdviseStudy::Case& of_;
  const Solution& solution_;
  const std::function<void(const std::string&)>& note_;
  const Workbench bench_;
  const Observed expected_;
  StepCosts costs_;
  std::vector<BruteForceRun> runs_;
};

} // namespace

Table advise_table(const AdviseStudy& study, const std::string& oracle,
                   const std::function<void(const std::string&)>& note) {
  Table table{{"experiment",
               "scale",
               "scene",
               "set",
               "elements",
               "quantity",
               "end_time_s",
               "tolerance",
               "model",
               "integrator",
               "precision",
               "dt_s",
               "rtol",
               "variant",
               "threads",
               "error_estimate",
               "true_error",
               "solution_error",
               "measured_wall_s",
               "cheapest_model",
               "cheapest_integrator",
               "cheapest_precision",
               "cheapest_dt_s",
               "cheapest_rtol",
               "cheapest_variant",
               "cheapest_threads",
               "cheapest_true_error",
               "cheapest_measured_wall_s",
               "time_over_cheapest",
               "verdict",
               "brute_force_runs",
               "paper_wall_s",
               "paper_error",
               "speedup_over_paper",
               "advise_s",
               "status",
               "reason"},
              {}};
  std::error_code error;
  std::filesystem::create_directories(oracle,
                                      error); // writing the solution reports any error
  std::vector<Solution> solutions(study.cases.size());
  std::mutex of_notes;
  const auto note_safely = [&](const std::string& what) {
    const std::lock_guard lock(of_notes);
    note(what);
  };
  for_each_on_all_cores(study.cases.size(), [&](std::size_t c) {
    solutions[c] = kept_solution(study, study.cases[c], oracle, note_safely);
  });
  for (std::size_t c = 0; c < study.cases.size(); ++c)
    for (Record& row : CaseRows(study, study.cases[c], solutions[c], note).rows())
      table.rows.push_back(std::move(row));
  return table;
}

std::string advise_study_text(const AdviseStudy& study, const Table& table) {
  std::vector<std::vector<std::string>> rows;
  double worst = 0;
  std::size_t slower = 0, judged = 0;
  for (const Record& row : table.rows) {
    const auto choice = [&](const std::string& prefix) {
      return fmt::format(
          "{} {} {} {}{} x {}", text_in(row, prefix + "model"), text_in(row, prefix + "integrator"),
          text_in(row, prefix + "precision"),
          text_in(row, prefix + "rtol").empty() ? "" : shown(row, prefix + "rtol", "rtol {:.1g} "),
          text_in(row, prefix + "variant"), text_in(row, prefix + "threads"));
    };
    rows.push_back({text_in(row, "scene"), shown(row, "tolerance", "{:g}"), choice(""),
                    shown(row, "error_estimate", "{:.1e}"), shown(row, "true_error", "{:.1e}"),
                    shown(row, "measured_wall_s", "{:.4g}", 1e3), choice("cheapest_"),
                    shown(row, "cheapest_measured_wall_s", "{:.4g}", 1e3),
                    shown(row, "time_over_cheapest", "{:.2f}"),
                    shown(row, "speedup_over_paper", "{:.3g}"), shown(row, "advise_s", "{:.2f}"),
                    text_in(row, "verdict"), text_in(row, "status"), text_in(row, "reason")});
    if (text_in(row, "time_over_cheapest").empty()) continue;
    ++judged;
    slower += text_in(row, "verdict") == "slower";
    worst = std::max(worst, number_in(row, "time_over_cheapest"));
  }
  return fmt::format(
      "{} ({}, scale {})\n{}At most {:.2f} times the cheapest configuration found; above the bar "
      "of {:g}: {} of {}.\n",
      study.title, study.name, study.scale,
      text_table({"scene", "tolerance", "advised", "estimate", "true", "[ms]", "cheapest", "[ms]",
                  "ratio", "over paper", "advise [s]", "verdict", "status", "reason"},
                 rows),
      worst, study.bar, slower, judged);
}

} // namespace dss
