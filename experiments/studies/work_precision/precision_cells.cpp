#include "experiments/studies/work_precision/precision_cells.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "solver/numerics/stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace dss {
namespace {

constexpr long most_halvings = 1000; // 2^1000 is a double

/// Step limits of explicit methods on a cell's problem [s], by name; found once in this process.
const std::map<std::string_view, double>& step_limits(const Cell& cell) {
  static std::map<std::string, std::map<std::string_view, double>> known;
  const auto [place, is_new] = known.try_emplace(fmt::format("{} {}", cell.scene, cell.set_text()));
  if (!is_new) return place->second;
  const Scene scene = load_scene(cell.scene, cell.set);
  std::vector<const Method*> all;
  for (const Method& method : methods()) all.push_back(&method);
  const std::vector<StabilityLimit> limits = stable_steps(scene.problem, all);
  for (std::size_t n = 0; n < all.size(); ++n) place->second[all[n]->name] = limits[n].dt;
  return place->second;
}

/// Steps from one saved time to the next.
std::set<long> step_counts(ObjectNode& accuracy, const CellAccuracy& of,
                           const std::vector<int>& halvings) {
  std::set<long> counts;
  const double interval = of.times.interval();
  // Of methods that bear any step the interval, and of those that bear none.
  const double largest = of.step_limit > 0 ? std::min(of.step_limit, interval) : interval;
  if (const auto node = accuracy.find("halvings")) {
    const std::vector<int> own = read_halvings(*node);
    for (const int times : halvings.empty() ? own : halvings)
      counts.insert(of.times.steps_between(largest / std::exp2(times)));
  }
  if (const auto dt = accuracy.find("dt"))
    for (const Node& item : dt->list()) {
      const double step = item.positive();
      counts.insert(item.placed([&] { return of.times.whole_steps_between(step); }));
    }
  return counts;
}

/// One for each tolerance of adaptive steps. The first step that is tried is the largest stable
/// one.
std::vector<Cell> adaptive_cells(const Node& rtol, Cell cell, const CellAccuracy& of) {
  if (cell.integrator != dopri5_adaptive().name)
    rtol.fail(
        fmt::format("{} has no adaptive steps; {} has", cell.integrator, dopri5_adaptive().name));
  const long count = of.times.steps_between(std::min(of.step_limit, of.times.interval()));
  cell.dt = of.times.interval() / double(count);
  cell.steps = cell.full_steps = count * of.times.count;
  std::vector<Cell> cells;
  for (const double tolerance : rtol.positives()) {
    cell.rtol = tolerance;
    cells.push_back(cell);
  }
  return cells;
}

} // namespace

std::vector<int> read_halvings(const Node& node) {
  std::vector<int> halvings;
  for (const Node& item : node.list())
    halvings.push_back(int(item.whole(-most_halvings, most_halvings)));
  return halvings;
}

std::vector<Cell> with_steps(const Node& node, const std::vector<Cell>& cells,
                             PrecisionStudy& study) {
  ObjectNode accuracy(node);
  accuracy.allow({"halvings", "dt", "rtol"});
  const SavedTimes times = read_saved_times(accuracy, study.precision_scale.shorten);
  accuracy.finish();
  std::vector<Cell> more;
  const auto add = [&](const Cell& cell, const CellAccuracy& of) {
    more.push_back(cell);
    study.accuracy[cell.key()] = of;
  };
  for (Cell cell : cells) {
    const Method& method = require_method(cell.integrator);
    const CellAccuracy of{times, method.is_unlimited() ? std::numeric_limits<double>::infinity()
                                                       : step_limits(cell).at(method.name)};
    // The stages of fitted methods are those of each step, and so is their limit.
    const CellAccuracy of_step{times, method.is_fitted() ? 0 : of.step_limit};
    for (const long count : step_counts(accuracy, of, study.precision_scale.halvings)) {
      cell.dt = times.interval() / double(count);
      cell.steps = cell.full_steps = count * times.count;
      add(cell, of_step);
    }
    const auto rtol = accuracy.find("rtol");
    if (!rtol) continue;
    for (const Cell& adaptive : adaptive_cells(*rtol, cell, of)) add(adaptive, of);
  }
  if (more.empty())
    accuracy.fail("gives no step; give \"halvings\" such as [0, 1, 2], \"dt\" such as [1e-6], or "
                  "\"rtol\" such as "
                  "[1e-4] for adaptive ones");
  return more;
}

} // namespace dss
