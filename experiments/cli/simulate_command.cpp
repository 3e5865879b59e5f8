#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/run/plan/context.hpp"
#include "experiments/run/plan/exponential.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/nearest_name.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>

namespace dss {
namespace {

struct SimulateArguments {
  std::string scene, platform = "ten_gigabit", halo = "auto", decomposition = "strips",
                     precision = "f64", shares = "equal", json;
  std::string integrator;
  std::vector<std::string> set;
  int ranks = 0, steps = 20;
  std::vector<double> node_speeds; ///< element-steps/s of all or of each; empty: measured here
};

/// Speeds of the nodes: one of all, or one of each.
std::vector<NodeSpeed> given_speeds(const SimulateArguments& arguments, const Method& method) {
  std::vector<NodeSpeed> speeds;
  for (const double speed : arguments.node_speeds)
    speeds.push_back(given_speed("given", speed, method));
  if (speeds.size() > 1 && speeds.size() != std::size_t(arguments.ranks))
    throw InputError(fmt::format("--node-speed: {} speeds of {} nodes; give one, or one for each",
                                 speeds.size(), arguments.ranks));
  return speeds;
}

/// Parts in proportion to the speeds of their nodes, or equal.
Weights weights_of(const SimulateArguments& arguments) {
  if (arguments.shares != "equal" && arguments.shares != "measured")
    throw InputError(fmt::format("--shares {}: unknown; {}", arguments.shares,
                                 nearest_name(arguments.shares, names_of("SHARES"))));
  if (arguments.shares == "equal") return {};
  if (arguments.node_speeds.size() < 2)
    throw InputError("--shares measured: nodes of one speed have equal parts; give --node-speed a "
                     "speed for each");
  return {arguments.node_speeds, {}};
}

void require_strategy(const std::string& halo) {
  if (halo != "auto" && find_halo_strategy(halo) == nullptr)
    throw InputError(
        fmt::format("--halo {}: unknown strategy; {}", halo, nearest_name(halo, names_of("HALO"))));
  if (halo == "shared")
    throw InputError("--halo shared: every simulated rank is a node of its own; give deep");
}

/// A simulated scene, and the speeds of its nodes.
struct Simulated {
  std::vector<NodeSpeed> speeds; ///< of each node, or one of all
  std::string decomposition;
  /// A step [s] if nobody waits and nothing is exchanged, at the speeds that nodes have with the
  /// whole problem.
  double ideal_s = 0;
  SimulatedRun run;
};

Simulated simulated(const SimulateArguments& arguments, const SimulatedProblem& what) {
  const Platform platform(arguments.platform);
  Simulated result;
  result.speeds = given_speeds(arguments, what.method);
  const Decomposition decomposition =
      decompose(what.problem, arguments.decomposition, arguments.ranks, weights_of(arguments));
  result.decomposition = decomposition.method;
  std::vector<NodeSpeed> alone = result.speeds;
  if (result.speeds.empty()) {
    result.speeds.push_back(own_speed(what, decomposition));
    alone.push_back(arguments.ranks == 1 ? result.speeds.front()
                                         : own_speed(what, decompose(what.problem, "strips", 1)));
  }
  if (alone.size() == 1) alone.resize(std::size_t(arguments.ranks), alone.front());
  result.ideal_s = ideal_step_s(what, alone);
  result.run =
      simulate(make_plan(what, decomposition, result.speeds, arguments.halo, arguments.steps),
               platform.path());
  return result;
}

void print_simulated(const SimulateArguments& arguments, const SimulatedProblem& what,
                     const Simulated& simulated) {
  const SimulatedRun& run = simulated.run;
  const NodeSpeed& speed = simulated.speeds.front();
  const double elements = double(what.problem.lattice.element_count);
  fmt::print("{} on {} simulated nodes of {} ({:.3g} us, {:.4g} MB/s), {}, halo {}\n",
             what.problem.name, arguments.ranks, arguments.platform, 1e6 * run.latency_s,
             1e-6 / run.seconds_a_byte, simulated.decomposition, run.halo);
  if (simulated.speeds.size() > 1)
    fmt::print("nodes: {:.4g} million element-steps/s together, parts {}\n",
               1e-6 * elements / simulated.ideal_s,
               arguments.shares == "equal" ? "equal" : "in proportion to their speeds");
  else
    fmt::print("node: {:.4g} million element-steps/s at once, {:.4g} stage by stage ({})\n",
               1e-6 * speed.at_once / what.method.stages,
               1e-6 * speed.stage_by_stage / what.method.stages, speed.name);
  fmt::print("simulated: {:.6g} us a step, {:.4g} million element-steps/s, efficiency {:.3f}; "
             "{:.4g} us in exchanges\n",
             1e6 * run.step_s, 1e-6 * elements / run.step_s, simulated.ideal_s / run.step_s,
             1e6 * run.communication_s_per_step);
  fmt::print("{:.4g} messages and {:.4g} bytes a step\n", run.messages_per_step,
             run.bytes_per_step);
}

int simulate_scene(const SimulateArguments& arguments) {
  const std::vector<Override> overrides = parse_overrides(arguments.set);
  CommandFiles inputs;
  inputs.read_scene(arguments.scene, overrides);
  if (std::filesystem::is_regular_file(arguments.platform)) // a name is no file
    inputs.read("--platform", arguments.platform);
  require_sound_output(std::move(inputs), arguments.json);
  const Scene scene = load_scene(arguments.scene, overrides);
  const Precision precision = require_precision_name(arguments.precision);
  const Method& method = require_stepwise(require_method(
      arguments.integrator.empty() ? scene.problem.integrator : arguments.integrator));
  require_strategy(arguments.halo);
  const SimulatedProblem what{scene.problem, method, find_model(scene.model).value(), precision};
  const Simulated result = simulated(arguments, what);
  const SimulatedRun& run = result.run;
  // One number, or one for each node.
  const auto of_nodes = [&](double NodeSpeed::*speed) {
    nlohmann::ordered_json numbers;
    for (const NodeSpeed& node : result.speeds) numbers.push_back(node.*speed);
    return numbers.size() == 1 ? numbers.front() : numbers;
  };
  if (!arguments.json.empty())
    write_json(arguments.json,
               {{"context", measurement_context()},
                {"scene", scene.name},
                {"platform", arguments.platform},
                {"ranks", arguments.ranks},
                {"decomposition", result.decomposition},
                {"shares", arguments.shares},
                {"halo", run.halo},
                {"node_at_once_element_stages_per_s", of_nodes(&NodeSpeed::at_once)},
                {"node_stage_by_stage_element_stages_per_s", of_nodes(&NodeSpeed::stage_by_stage)},
                {"ideal_step_s", result.ideal_s},
                {"simulated_step_s", run.step_s},
                {"communication_s_per_step", run.communication_s_per_step},
                {"messages_per_step", run.messages_per_step},
                {"bytes_per_step", run.bytes_per_step},
                {"latency_s", run.latency_s},
                {"seconds_a_byte", run.seconds_a_byte},
                {"predicted_step_s", run.predicted_step_s},
                {"tried_step_s", run.tried_step_s}});
  if (arguments.json != "-") print_simulated(arguments, what, result);
  return exit_success;
}

/// Options of the speeds of nodes.
void add_node_options(CLI::App& command, SimulateArguments& arguments) {
  command
      .add_option("--node-speed", arguments.node_speeds,
                  "Speed of a node in element-steps/s, or one for each: S1,S2,... (default: "
                  "measured on one core of this machine)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::PositiveNumber);
  command
      .add_option("--shares", arguments.shares,
                  "Sizes of the parts: equal, or measured (by the speeds of their nodes)")
      ->capture_default_str()
      ->type_name("SHARES");
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
  add_node_options(*command, *arguments);
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
