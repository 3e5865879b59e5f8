#include "variants/mpi/strategy_choice.hpp"

#include "solver/numerics/signal_rows.hpp"
#include "variants/cost/halo_cost.hpp"
#include "variants/cost/trial.hpp"
#include "variants/mpi/distributed_part.hpp"
#include "variants/mpi/network.hpp"
#include "variants/mpi/part_json.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace dss {
namespace {

constexpr int timings = 3, sweeps = 3;
constexpr long least_steps = 8; ///< more than one, because the first exchange hides nothing
constexpr double never = std::numeric_limits<double>::infinity();

using StepTimes = std::map<const HaloStrategy*, double>;

/// One step of this rank's part under a strategy.
PlannedPart plan_own_part(const Setup& setup, const World& world,
                          const Decomposition& decomposition, const HaloStrategy& strategy,
                          const NodeSpeed& speed) {
  const StepSweeps of_step(setup.method, setup.problem);
  const PartSize size =
      part_size(setup.problem, decomposition, world.rank(), halo_depth(strategy, of_step));
  PartTimes times = part_times(size, strategy, of_step, setup.problem.lattice.row_reach(), speed);
  // On one node the processors themselves copy the messages, so nothing is computed meanwhile.
  if (world.is_one_node()) times = {times.compute_s, 0, 0, times.compute_s};
  return plan_part(size, times, setup.precision);
}

StepTimes predict(const Setup& setup, const Decomposition& decomposition, const NodeSpeed& speed,
                  const Network& network, World& world) {
  StepTimes step_s;
  for (const HaloStrategy& strategy : halo_strategies()) {
    if (strategy.transport == HaloStrategy::Transport::shared && !world.is_one_node()) continue;
    if (!strategy.is_possible(setup.threads)) continue;
    const PlannedPart own = plan_own_part(setup, world, decomposition, strategy, speed);
    PlannedStrategy planned{
        std::string(strategy.name), strategy.exchanges(setup.method.stages), {}};
    for (const std::string& text : world.gather(nlohmann::json(own).dump()))
      planned.parts.push_back(nlohmann::json::parse(text).get<PlannedPart>());
    step_s[&strategy] = world.largest(predicted_step_s(planned, network));
  }
  return step_s;
}

/// Time of a step under one strategy: the least of some timings [s].
double try_strategy(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition,
                    const HaloStrategy& strategy, World& world, const Fault& fault) {
  DistributedPart part(setup, plugin, decomposition, strategy, world, fault);
  const auto run_s = [&](long steps) {
    const std::vector<double> signals =
        signal_rows(part.part().problem, setup.method, setup.dt, 0, steps);
    world.meet();
    const double start_s = MPI_Wtime();
    part.advance(steps, signals);
    return world.largest(MPI_Wtime() - start_s);
  };
  long steps = least_steps;
  while (run_s(steps) < trial_s && steps < 1 << 16) steps *= 2;
  double least_s = never;
  for (int n = 0; n < timings; ++n) least_s = std::min(least_s, run_s(steps));
  return least_s / double(steps);
}

double least_of(const StepTimes& step_s) {
  double least = never;
  for (const auto& [strategy, seconds] : step_s) least = std::min(least, seconds);
  return least;
}

std::string text_of(const StepTimes& step_s) {
  std::string text;
  for (const HaloStrategy& strategy : halo_strategies())
    if (const auto found = step_s.find(&strategy); found != step_s.end())
      text += fmt::format("{}{} {:.4g} us", text.empty() ? "" : ", ", strategy.name,
                          1e6 * found->second);
  return text;
}

} // namespace

StrategyChoice choose_strategy(const Setup& setup, const Plugin& plugin,
                               const Decomposition& decomposition, const NodeSpeed& speed,
                               World& world, const Fault& fault) {
  StrategyChoice choice{nullptr, {}, measure_network(world.comm())};
  const StepTimes predicted = predict(setup, decomposition, speed, choice.network, world);
  // Faults of other kinds are for the run itself.
  const Fault slowness = fault.kind == Fault::Kind::slow ? fault : Fault{};
  // Large parts take long to make, so each is tried once.
  const bool is_large =
      setup.problem.lattice.element_count / std::size_t(world.ranks()) > large_part_elements;
  StepTimes tried;
  for (const auto& [strategy, seconds] : predicted)
    if (seconds <= worth_trying * least_of(predicted)) tried[strategy] = never;
  for (int sweep = 0; tried.size() > 1 && sweep < (is_large ? 1 : sweeps); ++sweep)
    for (auto& [strategy, seconds] : tried)
      seconds =
          std::min(seconds, try_strategy(setup, plugin, decomposition, *strategy, world, slowness));
  choice.halo =
      std::ranges::min_element(tried, {}, [](const auto& one) { return one.second; })->first;
  choice.reason = fmt::format("predicted step: {}", text_of(predicted));
  if (tried.size() > 1) choice.reason += fmt::format("; tried: {}", text_of(tried));
  return choice;
}

} // namespace dss
