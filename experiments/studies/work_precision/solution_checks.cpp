#include "experiments/studies/work_precision/solution_checks.hpp"
#include "experiments/measure/circumstances.hpp"
#include "experiments/run/plan/exponential.hpp"
#include "experiments/run/plan/run_plan.hpp"

#include <fmt/format.h>

namespace dss {

std::vector<std::string> SolutionChecks::options(const Cell& cell, long) {
  const SolutionRule& rule = study_.rules.solution;
  const CellAccuracy& of = study_.accuracy_of(cell);
  const Scene scene = load_scene(cell.scene, cell.set);
  const std::string key =
      fmt::format("{} {} at {} times to {:.17g} s, {}", cell.scene, scene_key(cell, scene),
                  of.times.count, of.times.end, rule.key());
  const auto make = [&](const std::string& path) {
    Solution solution = find_solution(
        scene.problem, require_stepwise(require_method(rule.integrator)), rule, of.times, note_);
    solution.key = key;
    write_solution(path, solution);
  };
  const std::string path = files_.file_of(
      key, "solution", [](const std::string& file) { return read_solution(file).key; }, make);
  std::vector<std::string> options{"--reference", path, "--repeat-for",
                                   fmt::format("{}", study_.precision_scale.repeat_for)};
  if (of.step_limit > 0)
    options.insert(options.end(), {"--stability-limit", fmt::format("{}", of.step_limit)});
  return options;
}

} // namespace dss
