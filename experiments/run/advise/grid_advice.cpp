#include "experiments/run/advise/grid_advice.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/run/advise/first_steps.hpp"
#include "experiments/run/advise/step_costs.hpp"
#include "experiments/run/state/run_states.hpp"
#include "solver/error.hpp"
#include "solver/model/energy.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr long least_value = 2;
constexpr int most_triples = 3;      ///< sets of three grids, each finer than the one before
constexpr double grid_margin = 1.05; ///< safety factor on the predicted parameter
/// Assumed error of the extrapolated limit, relative to the finest grid's error.
constexpr double of_limit_error = 0.25;

class GridSearch {
public:
  GridSearch(const std::string& scene, const std::vector<Override>& overrides,
             const std::string& parameter, const SavedTimes& times, const AdviseRequest& request,
             const std::function<void(const std::string&)>& note)
      : scene_(scene), overrides_(overrides), parameter_(parameter), times_(times),
        request_(request), note_(note), began_(Clock::now()) {}

  GridAdvice result() {
    long middle = checked_value();
    for (int triple = 0; triple < most_triples; ++triple) {
      // rounded down, so that the three grids have the exact ratio 2
      const long coarse = middle / 2;
      const long wanted = wanted_from({coarse, 2 * coarse, 4 * coarse});
      if (!advice_.failure.empty() || choose(wanted)) return std::move(advice_);
      middle = wanted;
    }
    advice_.failure = fmt::format(
        "--vary {}: no grid up to {} elements is within {:.2g}, half of the tolerance; the "
        "finest is off by {:.2g}",
        parameter_, advice_.runs.back().elements, allowed(), advice_.runs.back().error);
    return std::move(advice_);
  }

private:
  double allowed() const { return grid_share * request_.tolerance; }

  long checked_value() const {
    const auto refuse = [&](const std::string& what) {
      throw InputError(fmt::format("--vary {}: {}", parameter_, what));
    };
    const Scene scene = load_scene(scene_, overrides_);
    const auto found = scene.parameters.find(parameter_);
    std::vector<std::string> known;
    for (const auto& [name, value] : scene.parameters) known.push_back(name);
    if (known.empty()) refuse("the scene has no parameters");
    if (found == scene.parameters.end())
      refuse(fmt::format("the scene has no such parameter; {}", nearest_name(parameter_, known)));
    if (found->second != std::floor(found->second) || found->second < 2 * least_value)
      refuse(fmt::format("is {:g}; give one that is a whole number of {} or more", found->second,
                         2 * least_value));
    if (request_.quantity == Quantity::stress)
      refuse("stress of elements has no counterpart on another grid; give --quantity displacement "
             "or energy");
    if (request_.quantity == Quantity::displacement && scene.problem.loads.empty())
      refuse("the scene has no load, whose elements' displacement would be compared; give "
             "--quantity energy");
    if (grid(long(found->second) * 2).problem.lattice.element_count ==
        scene.problem.lattice.element_count)
      refuse("does not change the number of elements");
    return long(found->second);
  }

  Scene grid(long value) const {
    std::vector<Override> set = overrides_;
    set.push_back({parameter_, fmt::format("{}", value)});
    return load_scene(scene_, set);
  }

  /// Result of a grid; each is computed once.
  const GridRun& run(long value) {
    const auto place = std::ranges::lower_bound(advice_.runs, value, {}, &GridRun::value);
    if (place != advice_.runs.end() && place->value == value) return *place;
    const Scene scene = grid(value);
    GridRun run{value, scene.problem.lattice.element_count, history(scene), 0};
    if (note_) note_(fmt::format("grid {} = {}: {} elements", parameter_, value, run.elements));
    return *advice_.runs.insert(place, std::move(run));
  }

  /// Runs dopri5 in f64 at half its largest step, in the smallest exact model. The error in time is
  /// then far below the error of the grid.
  History history(const Scene& scene) const {
    RunRequest run;
    run.scene = scene_;
    run.overrides = overrides_;
    run.integrator = "dopri5";
    run.threads = 1;
    run.model = std::string(name(smallest_exact(scene.problem)));
    run.overrides.push_back({parameter_, fmt::format("{:g}", scene.parameters.at(parameter_))});
    run.dt = times_.interval() / double(2 * first_steps(scene.problem, times_).at("dopri5"));
    History history;
    for (const std::vector<double>& state : run_states(run, times_))
      history.push_back(compared(scene.problem, state));
    return history;
  }

  Vec3 compared(const Problem& problem, const std::vector<double>& state) const {
    if (request_.quantity == Quantity::energy) return {total_energy(problem, state), 0, 0};
    Vec3 mean{};
    const std::vector<std::size_t>& elements = problem.loads.front().elements;
    for (const std::size_t element : elements)
      for (std::size_t axis = 0; axis < 3; ++axis)
        mean[axis] += state[element * field_count + axis] / double(elements.size());
    return mean;
  }

  /// Judges three grids.
  /// @return the value that should meet the tolerance; 0 after a failure
  long wanted_from(const std::array<long, 3>& values) {
    std::array<History, 3> histories;
    for (std::size_t n = 0; n < 3; ++n) {
      const double spent_s = seconds_since(began_);
      if (spent_s > request_.budget_s.value_or(least_budget_s) / 2) {
        advice_.failure =
            fmt::format("--vary {}: grids so fine need more than half of --budget", parameter_);
        return 0;
      }
      histories[n] = run(values[n]).history;
    }
    const double ratio = double(values[2]) / double(values[1]);
    const Extrapolation found = extrapolate(histories, ratio);
    if (!found.converges) {
      advice_.failure = fmt::format(
          "--vary {}: results do not converge from {} over {} to {}: the scene does not keep one "
          "body, or the grids are too coarse",
          parameter_, values[0], values[1], values[2]);
      return 0;
    }
    advice_.order = found.order;
    limit_ = limit_of(histories[1], histories[2], ratio, found.order);
    const double coarse = distance(histories[0]), finest = distance(histories[2]);
    limit_error_ = of_limit_error * finest;
    const double room = allowed() - limit_error_;
    if (room <= 0) return 2 * values[2]; // finds a better limit first
    return std::max(least_value,
                    long(std::ceil(double(values[0]) * std::pow(coarse / room, 1 / found.order) *
                                   grid_margin)));
  }

  static History limit_of(const History& middle, const History& fine, double ratio, double order) {
    const double weight = 1 / (std::pow(ratio, order) - 1);
    History limit = fine;
    for (std::size_t k = 0; k < fine.size(); ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        limit[k][axis] += weight * (fine[k][axis] - middle[k][axis]);
    return limit;
  }

  /// Largest distance from the limit, relative to the limit's largest length.
  double distance(const History& history) const {
    double most = 0, scale = 0;
    for (std::size_t k = 0; k < history.size(); ++k) {
      const Vec3 &a = history[k], &b = limit_[k];
      most = std::max(most, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
      scale = std::max(scale, std::hypot(b[0], b[1], b[2]));
    }
    return relative(most, scale);
  }

  /// Chooses the coarsest grid that meets the tolerance, among those computed and the wanted one.
  /// @return true if there is one
  bool choose(long wanted) {
    if (wanted <= advice_.runs.back().value) run(wanted);
    for (GridRun& run : advice_.runs) run.error = distance(run.history) + limit_error_;
    for (const GridRun& run : advice_.runs)
      if (run.error <= allowed()) {
        advice_.value = run.value;
        advice_.error = run.error;
        return true;
      }
    return false;
  }

  const std::string& scene_;
  const std::vector<Override>& overrides_;
  const std::string& parameter_;
  const SavedTimes times_;
  const AdviseRequest& request_;
  const std::function<void(const std::string&)>& note_;
  const Clock::time_point began_;
  History limit_;
  double limit_error_ = 0;
  GridAdvice advice_;
};

} // namespace

GridAdvice advise_grid(const std::string& scene, const std::vector<Override>& overrides,
                       const std::string& parameter, const SavedTimes& times,
                       const AdviseRequest& request,
                       const std::function<void(const std::string&)>& note) {
  return GridSearch(scene, overrides, parameter, times, request, note).result();
}

} // namespace dss
