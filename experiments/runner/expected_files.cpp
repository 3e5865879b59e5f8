#include "experiments/runner/expected_files.hpp"
#include "experiments/runner/circumstances.hpp"
#include "experiments/runner/oracle_state.hpp"
#include "experiments/runner/run_plan.hpp"
#include "solver/numerics/stability.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace dss {

namespace {

Rotation rotation_of(const Cell& cell) { return rotation_of(find_model(cell.model).value_or(Model::spatial)); }

/// Nothing where they are those of the spatial model, as in files of before there were others.
std::string equations_of(const Cell& cell) {
  const Rotation rotation = rotation_of(cell);
  return rotation == Rotation::quaternion ? "" : fmt::format(", {} rotations", name(rotation));
}

} // namespace

std::string ExpectedFiles::file_of(const Cell& cell) {
  const long steps = std::min(cell.steps, study_.scale.oracle_steps);
  const Scene scene = load_scene(cell.scene, cell.set);
  const std::string of_scene =
      fmt::format("{} {} elements, {}", cell.set_text(), scene.problem.lattice.element_count, scene_digest(scene));
  const std::string key =
      cell.is_of_precision()
          ? fmt::format("{} {} at {} times to {:.17g} s, {} to {:g}", cell.scene, of_scene, cell.times.count,
                        cell.times.end, study_.precision->solution.integrator, study_.precision->solution.tolerance)
          : fmt::format("{} {} {} steps of {:.17g} s, {}", cell.scene, cell.integrator, steps, scene.problem.dt,
                        of_scene) +
                equations_of(cell);
  const std::string path = fmt::format("{}/{:016x}.{}", directory_, std::hash<std::string>{}(key),
                                       cell.is_of_precision() ? "solution" : "state");
  if (made_.contains(path)) return path;
  const bool is_there = keeps_ && std::filesystem::exists(path);
  if (cell.is_of_precision()) {
    if (!is_there || read_solution(path).key != key) make_solution(cell, scene, key, path);
  } else {
    if (!is_there || read_oracle_state(path).key != key) make_oracle_state(cell, scene, key, path);
  }
  made_.insert(path);
  return path;
}

void ExpectedFiles::make_oracle_state(const Cell& cell, const Scene& scene, const std::string& key,
                                      const std::string& path) const {
  const Method method = fitted(scene.problem, require_method(cell.integrator), scene.problem.dt);
  const long steps = std::min(cell.steps, study_.scale.oracle_steps);
  require_stable(scene.problem, method, scene.problem.dt, false);
  note_(fmt::format("oracle: {} {}, {} steps", cell.scene, cell.set_text(), steps));
  write_oracle_state(path,
                     compute_oracle_state(scene.problem, method, rotation_of(cell), scene.problem.dt, steps, key));
}

void ExpectedFiles::make_solution(const Cell& cell, const Scene& scene, const std::string& key,
                                  const std::string& path) const {
  const SolutionRule& rule = study_.precision->solution;
  Solution solution = find_solution(scene.problem, require_method(rule.integrator), rule, cell.times, note_);
  solution.key = key;
  write_solution(path, solution);
}

} // namespace dss
