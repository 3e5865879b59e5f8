#include "experiments/runner/precision/precision_cells.hpp"
#include "experiments/runner/run_plan.hpp"
#include "solver/numerics/stability.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace dss {
namespace {

/// Step limit of a cell's method on its problem [s], found once in this process.
double step_limit(const Cell& cell) {
  static std::map<std::string, double> limits;
  const auto [place, is_new] =
      limits.try_emplace(fmt::format("{} {} {}", cell.scene, cell.set_text(), cell.integrator), 0);
  if (is_new) {
    const Scene scene = load_scene(cell.scene, cell.set);
    const bool is_small = scene.problem.lattice.element_count <= sharp_stability_elements;
    place->second = stable_step(scene.problem, require_method(cell.integrator), is_small).dt;
  }
  return place->second;
}

/// Steps from one saved time to the next.
std::set<long> step_counts(const JsonPlace& accuracy, const Cell& cell, const Scale& scale) {
  std::set<long> counts;
  const double largest =
      std::min(cell.step_limit, cell.times.interval()); // methods without a limit have an infinite one
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
  if (counts.empty())
    accuracy.fail("gives no step; give \"halvings\" such as [0, 1, 2], \"dt\" such as [1e-6], or both");
  return counts;
}

} // namespace

SavedTimes read_saved_times(const JsonPlace& place, double shorten) {
  return {place["end_time"].positive() * shorten, place["saved_times"].count(1)};
}

std::vector<Cell> with_steps(const JsonPlace& accuracy, const std::vector<Cell>& cells, const Scale& scale) {
  accuracy.require_keys({"end_time", "saved_times", "halvings", "dt"});
  const SavedTimes times = read_saved_times(accuracy, scale.shorten);
  std::vector<Cell> more;
  for (Cell cell : cells) {
    cell.times = times;
    cell.step_limit = step_limit(cell);
    for (const long count : step_counts(accuracy, cell, scale)) {
      cell.dt = times.interval() / double(count);
      cell.steps = cell.full_steps = count * times.count;
      more.push_back(cell);
    }
  }
  return more;
}

} // namespace dss
