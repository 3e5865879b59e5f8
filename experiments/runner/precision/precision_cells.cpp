#include "experiments/runner/precision/precision_cells.hpp"
#include "experiments/runner/run_plan.hpp"
#include "solver/numerics/stability.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace dss {
namespace {

/// Step limits of all methods on a cell's problem [s], by name; found once in this process.
const std::map<std::string_view, double>& step_limits(const Cell& cell) {
  static std::map<std::string, std::map<std::string_view, double>> known;
  const auto [place, is_new] = known.try_emplace(fmt::format("{} {}", cell.scene, cell.set_text()));
  if (!is_new) return place->second;
  const Scene scene = load_scene(cell.scene, cell.set);
  const std::vector<const Method*> all = all_methods();
  const std::vector<StabilityLimit> limits = stable_steps(scene.problem, all);
  for (std::size_t n = 0; n < all.size(); ++n) place->second[all[n]->name] = limits[n].dt;
  return place->second;
}

/// Steps from one saved time to the next.
std::set<long> step_counts(const JsonPlace& accuracy, const Cell& cell, const Scale& scale) {
  std::set<long> counts;
  // Of methods that bear any step the interval, and of those that bear none.
  const double largest = cell.step_limit > 0 ? std::min(cell.step_limit, cell.times.interval()) : cell.times.interval();
  if (accuracy.has("halvings"))
    for (const int halvings : scale.halvings.empty() ? accuracy["halvings"].whole_numbers() : scale.halvings)
      counts.insert(cell.times.steps_between(largest / std::exp2(halvings)));
  if (accuracy.has("dt"))
    for (const JsonPlace& item : accuracy["dt"].items()) {
      try {
        counts.insert(cell.times.whole_steps_between(item.positive()));
      } catch (const InputError& error) {
        item.fail(error.what());
      }
    }
  return counts;
}

/// One for each tolerance of adaptive steps. The first step that is tried is the largest stable one.
std::vector<Cell> adaptive_cells(const JsonPlace& rtol, Cell cell) {
  if (cell.integrator != dopri5_adaptive().name)
    rtol.fail(fmt::format("{} has no adaptive steps; {} has", cell.integrator, dopri5_adaptive().name));
  const long count = cell.times.steps_between(std::min(cell.step_limit, cell.times.interval()));
  cell.dt = cell.times.interval() / double(count);
  cell.steps = cell.full_steps = count * cell.times.count;
  std::vector<Cell> cells;
  for (const JsonPlace& item : rtol.items()) {
    cell.rtol = item.positive();
    cells.push_back(cell);
  }
  return cells;
}

} // namespace

SavedTimes read_saved_times(const JsonPlace& place, double shorten) {
  return {place["end_time"].positive() * shorten, place["saved_times"].count(1)};
}

std::vector<Cell> with_steps(const JsonPlace& accuracy, const std::vector<Cell>& cells, const Scale& scale) {
  accuracy.require_keys({"end_time", "saved_times", "halvings", "dt", "rtol"});
  const SavedTimes times = read_saved_times(accuracy, scale.shorten);
  std::vector<Cell> more;
  for (Cell cell : cells) {
    cell.times = times;
    cell.step_limit = step_limits(cell).at(require_method(cell.integrator).name);
    for (const long count : step_counts(accuracy, cell, scale)) {
      cell.dt = times.interval() / double(count);
      cell.steps = cell.full_steps = count * times.count;
      more.push_back(cell);
      if (cell.integrator == "rkc2")
        more.back().step_limit = 0; // its stages are fitted to each step, and so is its limit
    }
    if (!accuracy.has("rtol")) continue;
    const std::vector<Cell> adaptive = adaptive_cells(accuracy["rtol"], cell);
    more.insert(more.end(), adaptive.begin(), adaptive.end());
  }
  if (more.empty())
    accuracy.fail("gives no step; give \"halvings\" such as [0, 1, 2], \"dt\" such as [1e-6], or \"rtol\" such as "
                  "[1e-4] for adaptive ones");
  return more;
}

} // namespace dss
