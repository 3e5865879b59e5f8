#include "experiments/studies/advise/brute_force.hpp"
#include "experiments/run/advise/first_steps.hpp"
#include "experiments/run/advise/step_costs.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace dss {
namespace {

constexpr int points_of_octave = 4; ///< steps per factor of 2
constexpr int points_of_decade = 2; ///< tolerances of adaptive steps per factor of 10
/// an error above this share of the error with twice the step has stalled
constexpr double no_better = 0.95;
constexpr double beyond_cheapest = 1.5; ///< the search ends at this multiple of the cheapest time

/// Configurations of one model, method and precision, the cheapest first.
struct Line {
  Configuration first;
  int point = 0;
  double cost_s = 0; ///< predicted cost of the next one [s]
  std::vector<double> errors;

  Configuration next() const {
    Configuration configuration = first;
    if (first.rtol)
      configuration.rtol = *first.rtol * std::pow(10, -double(point) / points_of_decade);
    else
      configuration.steps_between = long(
          std::ceil(double(first.steps_between) * std::exp2(double(point) / points_of_octave)));
    return configuration;
  }
  bool has_stalled() const {
    const auto before = std::size_t(first.rtol ? points_of_decade : points_of_octave);
    return errors.size() > before && errors.back() > no_better * errors[errors.size() - 1 - before];
  }
  bool operator<(const Line& other) const {
    return cost_s > other.cost_s;
  } // the cheapest comes first
};

class BruteForce {
public:
  BruteForce(const Workbench& bench, StepCosts& costs, const Observed& solution,
             double least_tolerance)
      : bench_(bench), costs_(costs), solution_(solution), least_tolerance_(least_tolerance) {}

  std::vector<BruteForceRun> result() {
    begin_lines();
    while (!lines_.empty() && lines_.top().cost_s <= beyond_cheapest * cheapest_s_) {
      Line line = lines_.top();
      lines_.pop();
      advance(line);
    }
    return std::move(runs_);
  }

private:
  void begin_lines() {
    const std::map<std::string_view, long> first = first_steps(bench_.problem(), bench_.times());
    for (const Model model : models) {
      if (!why_not(model, bench_.problem()).empty()) continue;
      for (const Precision precision : precisions) {
        for (const auto& [method, steps] : first)
          if (is_linear(model) || !find_method(method)->is_exponential)
            begin({model, find_method(method), precision, steps, {}, "", 1});
        begin({model, find_method("dopri5"), precision, first.at("dopri5"), 0.1, "", 1});
      }
    }
  }
  void begin(const Configuration& configuration) {
    Line line{costs_.placed(configuration), 0, 0, {}};
    line.cost_s = costs_.run_time(line.first);
    lines_.push(line);
  }

  void advance(Line& line) {
    const Configuration configuration = line.next();
    if (configuration.rtol && *configuration.rtol < least_rtol(configuration.precision)) return;
    const Observation observation = bench_.run(configuration);
    const double error = observation.failure.empty() ? bench_.error(solution_, observation.observed)
                                                     : std::numeric_limits<double>::infinity();
    line.errors.push_back(error);
    if (std::isfinite(error)) runs_.push_back({configuration, error, observation.wall_s});
    if (error <= least_tolerance_) {
      cheapest_s_ = std::min(cheapest_s_, observation.wall_s);
      return; // shorter steps cost more
    }
    if (line.has_stalled() && std::isfinite(error)) return;
    ++line.point;
    while (!line.first.rtol && line.next().steps_between == configuration.steps_between)
      ++line.point;
    line.cost_s = line.first.rtol ? observation.wall_s : costs_.run_time(line.next());
    lines_.push(line);
  }

  static double least_rtol(Precision precision) {
    return 8 * (is_single(precision) ? double(std::numeric_limits<float>::epsilon())
                                     : std::numeric_limits<double>::epsilon());
  }

  const Workbench& bench_;
  StepCosts& costs_;
  const Observed& solution_;
  const double least_tolerance_;
  double cheapest_s_ = std::numeric_limits<double>::infinity();
  std::priority_queue<Line> lines_;
  std::vector<BruteForceRun> runs_;
};

} // namespace

std::vector<BruteForceRun> brute_force(const Workbench& bench, StepCosts& costs,
                                       const Observed& solution, double least_tolerance) {
  return BruteForce(bench, costs, solution, least_tolerance).result();
}

} // namespace dss
