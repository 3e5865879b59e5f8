#include "experiments/cli/arguments.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/run/plan/context.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/nearest_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>

namespace dss {
namespace {

struct SimulateArguments {
  std::string scene, platform = "ten_gigabit", halo = "auto", decomposition = "strips",
                     precision = "f64", json;
  std::string integrator;
  std::vector<std::string> set;
  int ranks = 0, steps = 20;
  double node_speed = 0; ///< element-steps/s; 0: measured here
};

int simulate_scene(const SimulateArguments& arguments) {
  const Scene scene = load_scene(arguments.scene, parse_overrides(arguments.set));
  const Precision precision = require_precision_name(arguments.precision);
  const Method& method = require_method(arguments.integrator.empty() ? scene.problem.integrator
                                                                     : arguments.integrator);
  if (arguments.halo != "auto" && find_halo_strategy(arguments.halo) == nullptr)
    throw InputError(fmt::format("--halo {}: unknown strategy; {}", arguments.halo,
                                 nearest_name(arguments.halo, names_of("HALO"))));
  if (arguments.halo == "shared")
    throw InputError("--halo shared: every simulated rank is a node of its own; give deep");
  const Platform platform(arguments.platform);
  const SimulatedProblem what{scene.problem, method, find_model(scene.model).value(), precision};
  const Decomposition decomposition =
      decompose(scene.problem, arguments.decomposition, arguments.ranks);
  const NodeSpeed speed = arguments.node_speed > 0
                              ? given_speed("given", arguments.node_speed, method)
                              : own_speed(what, decomposition);
  const NodeSpeed alone = // one node with the whole problem, the base of efficiencies
      arguments.node_speed > 0 || arguments.ranks == 1
          ? speed
          : own_speed(what, decompose(scene.problem, "strips", 1));
  const SimulatedRun run = simulate(
      make_plan(what, decomposition, speed, arguments.halo, arguments.steps), platform.path());
  const double elements = double(scene.problem.lattice.element_count);
  if (!arguments.json.empty())
    write_json(arguments.json, {{"context", measurement_context()},
                                {"scene", scene.name},
                                {"platform", arguments.platform},
                                {"ranks", arguments.ranks},
                                {"decomposition", decomposition.method},
                                {"halo", run.halo},
                                {"node_at_once_element_stages_per_s", speed.at_once},
                                {"node_stage_by_stage_element_stages_per_s", speed.stage_by_stage},
                                {"simulated_step_s", run.step_s},
                                {"communication_s_per_step", run.communication_s_per_step},
                                {"messages_per_step", run.messages_per_step},
                                {"bytes_per_step", run.bytes_per_step},
                                {"latency_s", run.latency_s},
                                {"seconds_a_byte", run.seconds_a_byte},
                                {"predicted_step_s", run.predicted_step_s},
                                {"tried_step_s", run.tried_step_s}});
  if (arguments.json == "-") return exit_success;
  fmt::print("{} on {} simulated nodes of {} ({:.3g} us, {:.4g} MB/s), {}, halo {}\n", scene.name,
             arguments.ranks, arguments.platform, 1e6 * run.latency_s, 1e-6 / run.seconds_a_byte,
             decomposition.method, run.halo);
  fmt::print("node: {:.4g} million element-steps/s at once, {:.4g} stage by stage ({})\n",
             1e-6 * speed.at_once / method.stages, 1e-6 * speed.stage_by_stage / method.stages,
             speed.name);
  fmt::print("simulated: {:.6g} us a step, {:.4g} million element-steps/s, efficiency {:.3f}; "
             "{:.4g} us in exchanges\n",
             1e6 * run.step_s, 1e-6 * elements / run.step_s,
             elements * method.stages / alone.at_once / run.step_s / arguments.ranks,
             1e6 * run.communication_s_per_step);
  fmt::print("{:.4g} messages and {:.4g} bytes a step\n", run.messages_per_step,
             run.bytes_per_step);
  return exit_success;
}

} // namespace

void add_simulate_command(CLI::App& app, Chosen& chosen) {
  std::vector<std::string> halos = names_of("HALO");
  std::erase(halos, "shared"); // every simulated rank is a node of its own
  CLI::App* command =
      app.add_subcommand("simulate", "Simulate a scene's exchanges on a cluster (SimGrid)");
  const auto arguments = std::make_shared<SimulateArguments>();
  command->add_option("SCENE", arguments->scene, "A name from `dssbench list scenes`, or a path")
      ->required();
  command->add_option("--ranks", arguments->ranks, "Number of nodes; each has one rank")
      ->required()
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--platform", arguments->platform,
                   "gigabit, ten_gigabit, fdr, or a SimGrid platform file; this_host: this "
                   "machine, measured by ping-pong between two ranks")
      ->capture_default_str()
      ->type_name("PLATFORM");
  command
      ->add_option("--halo", arguments->halo,
                   fmt::format("{}; auto: the fastest", fmt::join(halos, ", ")))
      ->capture_default_str()
      ->type_name("HALO");
  command
      ->add_option("--decomposition", arguments->decomposition,
                   fmt::format("{}", fmt::join(names_of("DECOMPOSITION"), ", ")))
      ->capture_default_str()
      ->type_name("DECOMPOSITION");
  command
      ->add_option(
          "--node-speed", arguments->node_speed,
          "Speed of a node in element-steps/s (default: measured on one core of this machine)")
      ->check(CLI::PositiveNumber);
  command->add_option("--precision", arguments->precision, "f64 or f32")
      ->capture_default_str()
      ->type_name("PRECISION");
  command
      ->add_option("--integrator", arguments->integrator,
                   fmt::format("{} (default: the scene's)", fmt::join(method_names(), ", ")))
      ->type_name("INTEGRATOR");
  command->add_option("--steps", arguments->steps, "Number of steps to simulate")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  command
      ->add_option("--set", arguments->set,
                   "Override a parameter or any number of the scene; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_option("--json", arguments->json, "File for the result, or - for standard output");
  command->footer("Example: dssbench simulate plate_paper --set n=300 --ranks 6 --platform "
                  "ten_gigabit --node-speed 1.211e6\n"
                  "(the paper's node: 90,000 elements, 10,000 steps in 743.14 s)");
  command->callback(
      [arguments, &chosen] { chosen = [arguments] { return simulate_scene(*arguments); }; });
}

} // namespace dss
