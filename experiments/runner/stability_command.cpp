#include "experiments/runner/arguments.hpp"
#include "experiments/runner/commands.hpp"
#include "experiments/runner/run_plan.hpp"
#include "solver/numerics/stability.hpp"

#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct StabilityArguments {
  std::string scene, integrator;
  std::vector<std::string> set;
};

int stability(const StabilityArguments& arguments) {
  const Scene scene = load_scene(arguments.scene, parse_overrides(arguments.set));
  const Method& method = require_method(arguments.integrator.empty() ? scene.problem.integrator : arguments.integrator);
  const bool is_small = scene.problem.lattice.element_count <= sharp_stability_elements;
  const StabilityLimit limit = stable_step(scene.problem, method, is_small);
  fmt::print("{}: {} is predicted stable up to dt = {:.6g} s; the scene's step is {:.6g} s ({:.3g} of the limit)\n",
             scene.name, method.name, limit.dt, scene.problem.dt, scene.problem.dt / limit.dt);
  fmt::print("largest frequency {:.6g} rad/s, largest damping rate {:.6g} 1/s; {}\n", limit.omega_max, limit.damping,
             limit.how);
  return exit_success;
}

} // namespace

void add_stability_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("stability", "Predict the largest stable step of a scene");
  const auto arguments = std::make_shared<StabilityArguments>();
  command->add_option("SCENE", arguments->scene, "A name from `dssbench list scenes`, or a path")->required();
  command->add_option("--integrator", arguments->integrator, method_names() + " (default: the scene's)");
  command->add_option("--set", arguments->set, "KEY=VALUE: a parameter or any number of the scene; may be repeated")
      ->allow_extra_args(false);
  command->footer("Example: dssbench stability plate_paper --set n=50 --integrator velocity_verlet");
  command->callback([arguments, &chosen] { chosen = [arguments] { return stability(*arguments); }; });
}

} // namespace dss
