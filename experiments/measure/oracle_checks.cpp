#include "experiments/measure/oracle_checks.hpp"
#include "experiments/measure/circumstances.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/state/oracle_state.hpp"
#include "solver/numerics/stability.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

Rotation rotation_of(const Cell& cell) {
  return rotation_of(find_model(cell.model).value_or(Model::spatial));
}

/// Empty for the spatial model's equations: files from before other equations existed have no such
/// text.
std::string equations_of(const Cell& cell) {
  const Rotation rotation = rotation_of(cell);
  return rotation == Rotation::quaternion ? "" : fmt::format(", {} rotations", name(rotation));
}

} // namespace

std::vector<std::string> OracleChecks::options(const Cell& cell, long repetition) {
  const Scene scene = load_scene(cell.scene, cell.set);
  const long steps = std::min(cell.steps, study_.scale.oracle_steps);
  const std::string key =
      fmt::format("{} {} {} steps of {:.17g} s, {}{}", cell.scene, cell.integrator, steps,
                  scene.problem.dt, scene_key(cell, scene), equations_of(cell));
  const std::string path = files_.file_of(
      key, "state", [](const std::string& file) { return read_oracle_state(file).key; },
      [&](const std::string& file) { compute(cell, scene, key, file); });
  std::vector<std::string> options{"--check-state", path};
  if (study_.scale.tail_checks > 0 && repetition >= study_.scale.tail_checks)
    options.insert(options.end(), {"--check-tail", "0", "--no-balance"});
  return options;
}

void OracleChecks::compute(const Cell& cell, const Scene& scene, const std::string& key,
                           const std::string& path) const {
  const Method method = fitted(scene.problem, require_method(cell.integrator), scene.problem.dt);
  const long steps = std::min(cell.steps, study_.scale.oracle_steps);
  require_stable(scene.problem, method, scene.problem.dt, false);
  note_(fmt::format("oracle: {} {}, {} steps", cell.scene, cell.set_text(), steps));
  write_oracle_state(path, compute_oracle_state(scene.problem, method, rotation_of(cell),
                                                scene.problem.dt, steps, key));
}

} // namespace dss
