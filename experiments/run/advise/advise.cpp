#include "experiments/run/advise/advise.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/run/advise/advice_text.hpp"
#include "experiments/run/advise/finals.hpp"
#include "experiments/run/advise/first_steps.hpp"
#include "experiments/run/advise/step_costs.hpp"
#include "experiments/run/advise/step_search.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace dss {
namespace {

/// first step of the reference, relative to the stability limit
constexpr double first_of_limit = 0.9;
/// A candidate is tried if its predicted time is below this multiple of the best time so far.
constexpr double of_interest = 1.3;
/// Share of the tolerance: `dssbench run` does not cut steps at our saved times.
constexpr double adaptive_margin = 0.8;
constexpr double never = std::numeric_limits<double>::infinity();

/// All trials for one scene and tolerance.
class Adviser {
public:
  Adviser(const Problem& problem, const SavedTimes& times, const AdviseRequest& request,
          const std::function<void(const std::string&)>& note)
      : bench_(problem, times, request.quantity), request_(request), note_(note),
        began_(Clock::now()), first_steps_(first_steps(problem, times)) {}

  Advice result() {
    costs_.emplace(bench_, spatial_rk4(), advised_variants(bench_.problem(), request_.variants),
                   request_.most_threads);
    plan_paper_run();
    find_models();
    if (find_own_reference()) {
      search_all();
      choose();
    }
    advice_.spent_s = spent_s();
    return std::move(advice_);
  }

private:
  double spent_s() const { return seconds_since(began_); }
  double left_s() const { return budget_s_ - spent_s(); }
  void note(const std::string& what) const {
    if (note_) note_(what);
  }

  Configuration spatial_rk4() const {
    Configuration configuration;
    configuration.method = find_method("rk4");
    configuration.steps_between = first_steps_.at("rk4");
    return configuration;
  }

  void plan_paper_run() {
    PaperRun& paper = advice_.paper;
    paper.configuration = costs_->placed(spatial_rk4());
    paper.configuration.steps_between = bench_.times().steps_between(bench_.problem().dt);
    paper.dt = bench_.dt(paper.configuration);
    paper.time_s = costs_->run_time(paper.configuration);
    if (paper.configuration.steps_between < first_steps_.at("rk4"))
      paper.reason = "its step is above the stability limit of rk4";
    budget_s_ = request_.budget_s.value_or(std::max(least_budget_s, budget_share * paper.time_s));
  }

  void find_models() {
    for (const Model model : models)
      if (std::string why = why_not(model, bench_.problem()); !why.empty())
        advice_.left_out.emplace_back(model, std::move(why));
      else
        models_.push_back(model);
    exact_ = smallest_exact(bench_.problem());
  }
  bool is_exact(Model model) const { return why_not_exact(model, bench_.problem()).empty(); }

  bool find_own_reference() {
    Configuration start;
    start.model = exact_;
    start.method = find_method("dopri5");
    start.steps_between = long(std::ceil(double(first_steps_.at("dopri5")) / first_of_limit));
    start = costs_->placed(start);
    note(fmt::format("reference: dopri5, f64, model {}, from steps of {:.3g} s", name(exact_),
                     bench_.dt(start)));
    advice_.reference = find_reference(bench_, start, request_.tolerance, left_s());
    const ReferenceRun& reference = advice_.reference;
    for (const ReferenceLevel& level : reference.levels)
      note(fmt::format("  {} steps: change by the next halving {:.2e}, {:.3g} s",
                       level.steps_between * bench_.times().count, level.change, level.wall_s));
    most_error_ = request_.tolerance - 2 * reference.error;
    advice_.failure = reference.failure;
    advice_.least_tolerance = reference.least_tolerance;
    return advice_.failure.empty();
  }

  /// One candidate for each model, method and precision, at its largest step. Runs of the exact
  /// model in f64 with rk4 or dopri5 come first; the others follow by their lowest possible cost.
  std::vector<Candidate> all_candidates() {
    std::vector<Candidate> all;
    for (const Model model : models_)
      for (const Precision precision : precisions)
        for (const auto& [name, steps] : first_steps_) {
          const Method& method = *find_method(name);
          if (method.is_exponential && !is_linear(model)) continue;
          Candidate candidate;
          candidate.configuration = {model, &method, precision, steps, {}, "", 1};
          candidate.configuration = costs_->placed(candidate.configuration);
          candidate.time_s = costs_->run_time(candidate.configuration);
          all.push_back(candidate);
        }
    const auto is_first = [&](const Candidate& candidate) {
      const Configuration& of = candidate.configuration;
      return of.model == exact_ && of.precision == Precision::f64 &&
             (of.method->name == "rk4" || of.method->name == "dopri5");
    };
    std::ranges::stable_sort(all, {}, &Candidate::time_s);
    std::stable_partition(all.begin(), all.end(), is_first);
    return all;
  }

  void search_all() {
    for (Candidate& candidate : all_candidates()) {
      search(candidate);
      advice_.candidates.push_back(candidate);
    }
    for (const Model model : models_)
      for (const Precision precision : {Precision::f64, Precision::f32})
        search_adaptive(model, precision);
  }

  /// Runs a configuration and returns its error against the reference; infinite if the run fails.
  double error_of(const Configuration& configuration, Candidate& candidate) {
    const Observation observation = bench_.run(configuration);
    candidate.error = observation.failure.empty()
                          ? bench_.error(advice_.reference.observed, observation.observed)
                          : never;
    candidate.time_s = observation.wall_s;
    if (!observation.failure.empty()) candidate.reason = observation.failure;
    return candidate.error;
  }

  /// A run whose error shows the error of the model, not of the step. It has as many steps as the
  /// second level of the reference.
  Configuration fine_run(Model model) {
    Configuration fine = advice_.reference.configuration;
    fine.model = model;
    fine.steps_between =
        advice_.reference.levels[std::min<std::size_t>(1, advice_.reference.levels.size() - 1)]
            .steps_between;
    return costs_->placed(fine);
  }
  /// Error of a model with fine steps; measured once.
  double model_error(Model model) {
    if (is_exact(model)) return 0;
    if (const auto known = model_errors_.find(model); known != model_errors_.end())
      return known->second;
    Candidate of_model;
    return model_errors_[model] = error_of(fine_run(model), of_model);
  }
  /// Expected time to measure that error [s].
  double model_error_s(Model model) {
    return is_exact(model) || model_errors_.contains(model) ? 0 : costs_->run_time(fine_run(model));
  }

  void search(Candidate& candidate) {
    Configuration& configuration = candidate.configuration;
    if (candidate.time_s > of_interest * best_s_) {
      candidate.reason = "even its largest stable step costs more";
      return;
    }
    if (left_s() < std::max(candidate.time_s, model_error_s(configuration.model)))
      return leave_out(candidate);
    if (const double error = model_error(configuration.model); error > most_error_) {
      candidate.status = Candidate::Status::no_model;
      candidate.error = error;
      candidate.reason = fmt::format("model {} is off by {:.2g}, whatever the step",
                                     name(configuration.model), error);
      return;
    }
    const auto with = [&](long steps) {
      Configuration other = configuration;
      other.steps_between = steps;
      return other;
    };
    const StepTask task{configuration.steps_between,
                        configuration.method->order,
                        most_error_,
                        std::min(of_interest * best_s_, left_s()),
                        [&](long steps) { return error_of(with(steps), candidate); },
                        [&](long steps) { return costs_->run_time(with(steps)); }};
    take(fewest_steps(task), task, candidate);
  }

  static void leave_out(Candidate& candidate) {
    candidate.status = Candidate::Status::out_of_budget;
    candidate.reason = "the trials' budget is spent";
  }

  void take(const StepResult& result, const StepTask& task, Candidate& candidate) {
    Configuration& configuration = candidate.configuration;
    if (result.steps > 0) configuration.steps_between = result.steps;
    if (result.runs > 0) candidate.error = result.error;
    candidate.time_s = costs_->run_time(configuration);
    switch (result.verdict) {
    case StepResult::Verdict::meets:
      candidate.status = Candidate::Status::meets;
      candidate.reason = "";
      if (candidate.time_s < best_s_) {
        best_s_ = candidate.time_s;
        note(describe(bench_, candidate));
      }
      return;
    case StepResult::Verdict::stalls:
      candidate.status = Candidate::Status::stalls;
      candidate.reason =
          fmt::format("shorter steps do not lower its error below {:.2g}: {}", result.error,
                      is_single(configuration.precision) ? "rounding" : "rounding, or its model");
      return;
    case StepResult::Verdict::costs_more:
      if (task.most_cost < of_interest * best_s_) return leave_out(candidate);
      if (!std::isfinite(candidate.error))
        candidate.status = Candidate::Status::unstable;
      else
        candidate.reason = "steps short enough cost more";
    }
  }

  /// Searches the largest tolerance of adaptive steps that meets the requested tolerance, to a
  /// factor of about 2.
  void search_adaptive(Model model, Precision precision) {
    constexpr double least_factor = 8; // relative to rounding; `dssbench run` requires 4
    const double least =
        least_factor * (is_single(precision) ? double(std::numeric_limits<float>::epsilon())
                                             : std::numeric_limits<double>::epsilon());
    Candidate candidate;
    candidate.configuration = {
        model, find_method("dopri5"), precision, first_steps_.at("dopri5"), 1.0, "", 1};
    candidate.configuration = costs_->placed(candidate.configuration);
    if (model_error_s(model) > left_s()) {
      leave_out(candidate);
      advice_.candidates.push_back(candidate);
      return;
    }
    if (model_error(model) > most_error_) return;
    std::optional<Candidate> found;
    double rtol = std::clamp(request_.tolerance, least, 0.1);
    for (int runs = 0; runs < 5; ++runs) {
      // Adaptive steps are not shorter than the stability limit for long. A run therefore costs
      // about as much as one with fixed steps of that length.
      Configuration fixed = candidate.configuration;
      fixed.rtol.reset();
      if (const double least_s = costs_->run_time(fixed);
          least_s > std::min(of_interest * best_s_, left_s()))
        break;
      candidate.configuration.rtol = rtol;
      const double error = error_of(candidate.configuration, candidate);
      const bool is_met = error <= adaptive_margin * most_error_;
      if (is_met && (!found || candidate.time_s < found->time_s)) found = candidate;
      if (!is_met && (found || candidate.time_s > of_interest * best_s_ || rtol == least)) break;
      const double next = rtol * std::clamp(0.7 * most_error_ / std::max(error, 1e-300), 1e-3, 1e3);
      if (is_met && next < 2 * rtol) break;
      rtol = std::clamp(next, least, 0.1);
      if (rtol == *candidate.configuration.rtol) break;
    }
    if (candidate.error == 0 && !found) return; // never run: it would cost more
    if (found) candidate = *found;
    candidate.status = found ? Candidate::Status::meets : Candidate::Status::costs_more;
    if (!found)
      candidate.reason = "tolerances of its steps small enough cost more, or are below rounding";
    if (found && candidate.time_s < best_s_) best_s_ = candidate.time_s;
    advice_.candidates.push_back(candidate);
  }

  void choose() {
    Finals finals(bench_, *costs_, advice_, left_s());
    finals.measure();
    std::vector<Candidate>& all = advice_.candidates;
    std::ranges::stable_sort(all, {}, [](const Candidate& candidate) {
      return std::pair(candidate.status != Candidate::Status::meets, candidate.time_s);
    });
    if (all.empty() || all.front().status != Candidate::Status::meets) return fail();
    advice_.chosen = all.front();
    all.erase(all.begin());
    for (Candidate& other : all)
      if (other.status == Candidate::Status::meets)
        other.reason =
            fmt::format("takes {:.3g} times as long", other.time_s / advice_.chosen.time_s);
    advice_.error_estimate = advice_.chosen.error + advice_.reference.error;
  }

  void fail() {
    double least = never;
    bool is_out_of_budget = false;
    for (const Candidate& candidate : advice_.candidates) {
      if (candidate.error > 0) least = std::min(least, candidate.error);
      is_out_of_budget |= candidate.status == Candidate::Status::out_of_budget;
    }
    advice_.least_tolerance = std::isfinite(least) ? least + 2 * advice_.reference.error : 0;
    advice_.failure = fmt::format(
        "nothing that was tried meets {:g}{}; the least error was {:.1e}", request_.tolerance,
        is_out_of_budget ? " within the budget of the trials (--budget)" : "", least);
  }

  Workbench bench_;
  const AdviseRequest& request_;
  const std::function<void(const std::string&)>& note_;
  const Clock::time_point began_;
  const std::map<std::string_view, long> first_steps_; ///< steps between saved times, by method
  std::optional<StepCosts> costs_;
  std::vector<Model> models_;
  Model exact_ = Model::spatial; ///< the smallest exact model
  std::map<Model, double> model_errors_;
  double budget_s_ = 0, most_error_ = 0, best_s_ = never;
  Advice advice_;
};

} // namespace

Advice advise(const Problem& problem, const SavedTimes& times, const AdviseRequest& request,
              const std::function<void(const std::string&)>& note) {
  if (!(request.tolerance > 0) || !std::isfinite(request.tolerance))
    throw InputError(
        fmt::format("--tolerance {:g}: give a positive number, 1e-4 for one", request.tolerance));
  return Adviser(problem, times, request, note).result();
}

} // namespace dss
