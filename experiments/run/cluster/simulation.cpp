#include "experiments/run/cluster/simulation.hpp"

#include "experiments/base/child.hpp"
#include "experiments/base/temporary_file.hpp"
#include "experiments/run/plan/exponential.hpp"
#include "solver/error.hpp"
#include "solver/io/program_files.hpp"
#include "variants/cost/trial.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>
#include <utility>

namespace dss {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t most_trial_elements = 1'000'000;
constexpr double time_limit_s = 1800;
/// Number of timings of a part; the best one counts, because noise in it would look like network
/// time. Parts above large_elements get fewer timings, because each takes much longer.
/// (measure_speed halves the number for parts above large_part_elements.)
constexpr int calibrations = 48, calibrations_of_large = 16;
constexpr std::size_t large_elements = 100'000;

/// Settings for SimGrid 3.32. With them, a ping-pong takes exactly the platform's latency and
/// bandwidth, computation takes the injected time, and a thousand ranks run in seconds. The
/// defaults describe one old cluster.
constexpr const char* settings[] = {
    // small messages do not wait for the receiver, as in Open MPI
    "--log=root.thresh:critical",
    "--cfg=network/model:SMPI",
    "--cfg=surf/precision:1e-9",
    "--cfg=smpi/privatization:no",
    "--cfg=smpi/tmpdir:/tmp",
    "--cfg=smpi/simulate-computation:no",
    "--cfg=smpi/host-speed:1Gf",
    "--cfg=smpi/cpu-threshold:0",
    "--cfg=smpi/wtime:0",
    "--cfg=smpi/async-small-thresh:65536",
    "--cfg=smpi/send-is-detached-thresh:65536",
    "--cfg=smpi/allgather:rdb",
    "--cfg=smpi/allreduce:rdb", // the default collectives take minutes at 1,024 ranks
    "--cfg=smpi/barrier:mpich",
    "--cfg=smpi/allgatherv:mpich_rdb",
    "--cfg=smpi/reduce:binomial",
    "--cfg=smpi/bcast:binomial_tree",
    "--cfg=contexts/stack-size:1024"};

std::string module_path() {
  const fs::path prefix = installed_prefix();
  return prefix.empty() ? DSS_SIMULATED_CLUSTER
                        : (prefix / "lib/dssbench/simulated_cluster.so").string();
}

/// A decomposition whose parts are small enough to be timed: the given one, or enough strips.
Decomposition trial_decomposition(const Problem& problem, const Decomposition& decomposition,
                                  std::size_t largest) {
  if (largest <= most_trial_elements) return decomposition;
  const std::size_t parts = problem.lattice.element_count / most_trial_elements + 1;
  return decompose(problem, "strips", int(parts));
}

/// Index of the largest part, and its number of elements.
std::pair<int, std::size_t> largest_part(const Problem& problem,
                                         const Decomposition& decomposition) {
  const std::vector<std::size_t> elements = part_elements(decomposition, problem.lattice);
  const auto most = std::ranges::max_element(elements);
  return {int(most - elements.begin()), *most};
}

} // namespace

SimulatedProblem simulated_problem(const Scene& scene) {
  return {scene.problem, require_stepwise(*find_method(scene.problem.integrator)),
          find_model(scene.model).value()};
}

std::vector<std::string> simulated_halos() {
  std::vector<std::string> names{"auto"};
  for (const HaloStrategy& strategy : halo_strategies())
    if (strategy.transport != HaloStrategy::Transport::shared) names.emplace_back(strategy.name);
  return names;
}

std::string why_no_simulation() {
  if (std::string_view(DSS_SMPIMAIN).empty()) return "built without SimGrid (libsimgrid-dev)";
  return ::access(DSS_SMPIMAIN, X_OK) == 0 ? "" : fmt::format("{} is not there", DSS_SMPIMAIN);
}

NodeSpeed given_speed(const std::string& name, double element_steps_per_s, const Method& method) {
  return {name, element_steps_per_s * method.stages, element_steps_per_s * method.stages};
}

NodeSpeed own_speed(const SimulatedProblem& what, const Decomposition& decomposition) {
  const std::size_t largest = largest_part(what.problem, decomposition).second;
  const Decomposition tried = trial_decomposition(what.problem, decomposition, largest);
  const int index = largest_part(what.problem, tried).first;
  const Setup setup{what.problem, what.method, what.model, what.precision, what.problem.dt};
  NodeSpeed speed = measure_speed(setup, load_variant("auto"), tried, index,
                                  largest > large_elements ? calibrations_of_large : calibrations);
  speed.name = "ours";
  return speed;
}

SimulationPlan make_plan(const SimulatedProblem& what, const Decomposition& decomposition,
                         std::span<const NodeSpeed> speeds, const std::string& halo, int steps,
                         int threads) {
  const auto speed_of = [&](std::size_t part) -> const NodeSpeed& {
    return speeds[speeds.size() == 1 ? 0 : part];
  };
  SimulationPlan plan{steps, halo, {}};
  const StepSweeps sweeps(what.method, what.problem);
  for (const bool is_every_stage : {true, false}) {
    std::vector<PartSize> sizes;
    for (int p = 0; p < decomposition.parts; ++p)
      sizes.push_back(part_size(what.problem, decomposition, p, sweeps.halo(is_every_stage)));
    for (const HaloStrategy& strategy : halo_strategies()) {
      if (strategy.is_every_stage != is_every_stage || !strategy.is_possible(threads) ||
          strategy.transport == HaloStrategy::Transport::shared)
        continue;
      PlannedStrategy planned{
          std::string(strategy.name), strategy.exchanges(what.method.stages), {}};
      for (std::size_t p = 0; p < sizes.size(); ++p)
        planned.parts.push_back(plan_part(
            sizes[p],
            part_times(sizes[p], strategy, sweeps, what.problem.lattice.row_reach(), speed_of(p)),
            what.precision));
      plan.strategies.push_back(std::move(planned));
    }
  }
  return plan;
}

double ideal_step_s(const SimulatedProblem& what, std::span<const NodeSpeed> speeds) {
  double together = 0;
  for (const NodeSpeed& speed : speeds) together += speed.at_once;
  return double(what.problem.lattice.element_count) * what.method.stages / together;
}

SimulatedRun simulate(const SimulationPlan& plan, const std::string& platform) {
  if (const std::string why = why_no_simulation(); !why.empty())
    throw InputError(fmt::format("simulate: {}", why));
  const std::size_t ranks = plan.strategies.front().parts.size();
  const TemporaryFile file(nlohmann::json(plan).dump(), ".json");
  std::vector<std::string> line = {"smpimain", module_path()};
  line.insert(line.end(), std::begin(settings), std::end(settings));
  line.insert(line.end(), {fmt::format("--cfg=smpi/np:{}", ranks), platform, file.path()});
  const ChildResult child = run_child(DSS_SMPIMAIN, line, time_limit_s);
  const nlohmann::ordered_json json = nlohmann::ordered_json::parse(child.output, nullptr, false);
  // SimGrid exits with code 0 even after a deadlock, so only the result counts
  if (!json.is_object()) {
    const std::string failure = child.failure(time_limit_s);
    throw InputError(fmt::format(
        "simulate: {} ranks on {}: {}", ranks, platform,
        failure.empty() ? "no result: " + child.error.substr(0, child.error.find('\n')) : failure));
  }
  return {json["halo"],
          json["step_s"],
          json["communication_s_per_step"],
          json["messages_per_step"],
          json["bytes_per_step"],
          json["latency_s"],
          json["seconds_a_byte"],
          json["predicted_step_s"],
          json["tried_step_s"]};
}

} // namespace dss
