#include "experiments/base/clock.hpp"
#include "experiments/run/statics/analysis.hpp"
#include "experiments/run/statics/analysis_model.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr int most_modes = 1000;

} // namespace

AnalysisResult solve_modal(const RunRequest& run, const AnalysisRequest& request) {
  if (request.modes < 1 || request.modes > most_modes)
    throw InputError(fmt::format("--modes {}: give 1 to {}", request.modes, most_modes));
  use_threads_for_factors(run.threads);
  const Scene scene = load_scene(run.scene, run.overrides);
  const Model model = modal_model(run, scene);
  if (request.is_prestressed && is_linear(model))
    throw InputError(fmt::format(
        "--prestressed: loads do not change the stiffness of the model {}; give --model "
        "spatial, or leave it out",
        name(model)));
  const auto start = Clock::now();
  StaticSystem system(scene.problem, rotation_of(model), degrees_of(model));
  const StaticSystem::State state = [&] {
    if (!request.is_prestressed) return system.rest();
    const Equilibrium found = find_equilibrium(system);
    if (!found.is_found)
      throw InputError(fmt::format("--prestressed: {}: {}", scene.name, found.reason));
    return found.state;
  }();
  AnalysisResult result;
  result.modal = find_modes(system, request.modes, state, !request.is_prestressed);
  result.wall_s = seconds_since(start);
  result.analysis = "modal";
  result.scene = scene.name;
  result.model = name(model);
  result.elements = scene.problem.lattice.element_count;
  result.links = scene.problem.link_count();
  result.unknowns = long(system.size());
  if (result.modal.modes.size() < std::size_t(request.modes))
    result.note =
        fmt::format("there are {} modes with a frequency in all", result.modal.modes.size());
  return result;
}

} // namespace dss
