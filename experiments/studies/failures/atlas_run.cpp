#include "experiments/studies/failures/atlas_run.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/timed/breakdown.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dss {
namespace {

/// An executor that steps from the initial state of its scene.
class AtlasRun {
public:
  AtlasRun(const AtlasCell& cell, double dt)
      : problem_(cell.scene.problem), method_(cell.method), dt_(dt),
        executor_(cell.plugin.create({
            .problem = problem_,
            .method = method_,
            .model = cell.model,
            .precision = cell.precision,
            .dt = dt,
            .rotation = cell.rotation,
        })) {
    write_initial_state(*executor_, problem_);
  }

  /// Advances by `steps` steps. @return false if the state became non-finite
  bool advance(long steps) {
    constexpr long piece = 4096; // signals are computed for this many steps at once
    for (const long end = step_ + steps; step_ < end;) {
      const long now = std::min(piece, end - step_);
      const Outcome outcome =
          executor_->advance(now, signal_rows(problem_, method_, dt_, step_, now));
      if (!outcome.is_finite) {
        breakdown_ = breakdown_text(outcome.what, step_ + outcome.step, dt_, outcome.element);
        return false;
      }
      step_ += now;
    }
    return true;
  }

  std::vector<double> state() { return whole_state(*executor_, problem_.lattice.element_count); }
  const std::string& breakdown() const { return breakdown_; }

private:
  const Problem& problem_;
  const Method& method_;
  double dt_;
  std::unique_ptr<Executor> executor_;
  long step_ = 0;
  std::string breakdown_;
};

AtlasFigure broken(const AtlasRun& run) {
  return {std::numeric_limits<double>::infinity(), run.breakdown()};
}

double largest_displacement(const std::vector<double>& state) {
  double most = 0;
  for (std::size_t e = 0; e < state.size(); e += field_count)
    most = std::max(most, std::hypot(state[e + ux], state[e + uy], state[e + uz]));
  return most;
}

double energy_trend(AtlasRun& run, long steps, reference::Dynamics<double>& dynamics) {
  // Hann weights remove oscillations even if the window does not contain whole periods.
  const auto mean = [&] {
    double sum = 0, weights = 0;
    for (long step = 0; step < trend_window; ++step) {
      if (!run.advance(1)) return std::numeric_limits<double>::infinity();
      const double root = std::sin(std::numbers::pi * (double(step) + 0.5) / double(trend_window));
      sum += root * root * dynamics.energy(run.state());
      weights += root * root;
    }
    return sum / weights;
  };
  const double first = mean();
  if (!run.breakdown().empty() || !run.advance(steps - 2 * trend_window)) return first;
  return mean() / first - 1;
}

double travel_error(const std::vector<double>& start, const std::vector<double>& expected,
                    const std::vector<double>& actual) {
  double difference = 0, way = 0;
  for (std::size_t e = 0; e < start.size(); e += field_count)
    for (std::size_t n = e; n < e + 3; ++n) {
      difference = std::max(difference, std::abs(actual[n] - expected[n]));
      way = std::max(way, std::abs(expected[n] - start[n]));
    }
  return difference / way;
}

/// Distance between the centres of the first and the last element, relative to that at rest.
double tip_gap(const Problem& problem, const std::vector<double>& state) {
  Vec3 first{}, last{};
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    if (e == 0) first = rest_position(problem, row, x);
    last = rest_position(problem, row, x);
  });
  double at_rest = 0, now = 0;
  const double* end = &state[state.size() - field_count];
  for (std::size_t a = 0; a < 3; ++a) {
    at_rest = std::hypot(at_rest, last[a] - first[a]);
    now = std::hypot(now, last[a] + end[a] - first[a] - state[a]);
  }
  return now / at_rest;
}

double error_at(const AtlasCell& cell, AtlasReferences& references, double t,
                const std::vector<double>& state) {
  std::vector<double> expected = references.at(t);
  align_turns(expected, state);
  return state_error(cell.scene.problem, expected, state);
}

/// Error at the end of a run with the step dt / parts.
AtlasFigure end_error(const AtlasCell& cell, AtlasReferences& references, long parts) {
  AtlasRun run(cell, cell.dt / double(parts));
  if (!run.advance(cell.steps * parts)) return broken(run);
  return {error_at(cell, references, cell.dt * double(cell.steps), run.state())};
}

AtlasFigure observed_order(const AtlasCell& cell, AtlasReferences& references) {
  const AtlasFigure coarse = end_error(cell, references, 1), fine = end_error(cell, references, 2);
  if (!coarse.breakdown.empty()) return coarse;
  return {std::log2(coarse.value / fine.value), fine.breakdown};
}

double end_figure(const AtlasCell& cell, const Parameters& parameters, AtlasReferences& references,
                  const std::vector<double>& state) {
  const Problem& problem = cell.scene.problem;
  const std::string& metric = cell.atlas.metric;
  if (metric == "energy_change") {
    reference::Dynamics<double> dynamics(problem);
    return dynamics.energy(state) / dynamics.energy(initial_state(problem)) - 1;
  }
  if (metric == "amplitude")
    return largest_displacement(state) / largest_displacement(initial_state(problem));
  if (metric == "tip_gap") return tip_gap(problem, state);
  if (metric == "value") {
    const double element = cell.atlas.element(parameters);
    if (!(element >= 0 && element < double(problem.lattice.element_count)))
      throw InputError(fmt::format("case {}: element {} is not one of the scene's {}",
                                   cell.atlas.name, element, problem.lattice.element_count));
    return state[std::size_t(element) * field_count + std::size_t(cell.atlas.field)] /
           cell.atlas.scale(parameters);
  }
  return travel_error(initial_state(problem), references.at(cell.dt * double(cell.steps)), state);
}

} // namespace

const std::vector<std::string>& atlas_metrics() {
  static const std::vector<std::string> all = {"error",         "travel_error", "observed_order",
                                               "energy_change", "energy_trend", "amplitude",
                                               "tip_gap",       "value"};
  return all;
}

bool needs_reference(const std::string& metric) {
  return metric == "error" || metric == "travel_error" || metric == "observed_order";
}

AtlasFigure measured_figure(const AtlasCell& cell, const Parameters& parameters,
                            AtlasReferences& references) {
  if (cell.atlas.metric == "error") return end_error(cell, references, 1);
  if (cell.atlas.metric == "observed_order") return observed_order(cell, references);
  AtlasRun run(cell, cell.dt);
  if (cell.atlas.metric == "energy_trend") {
    if (cell.steps < 10 * trend_window)
      throw InputError(fmt::format("case {}: energy_trend of {} steps; it needs {}",
                                   cell.atlas.name, cell.steps, 10 * trend_window));
    reference::Dynamics<double> dynamics(cell.scene.problem);
    const double trend = energy_trend(run, cell.steps, dynamics);
    return run.breakdown().empty() ? AtlasFigure{trend} : broken(run);
  }
  if (!run.advance(cell.steps)) return broken(run);
  return {end_figure(cell, parameters, references, run.state())};
}

} // namespace dss
