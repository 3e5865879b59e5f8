#include "variants/mpi/spread.hpp"

#include "solver/decomposition/decomposition_file.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"
#include "variants/halo_cost.hpp"
#include "variants/mpi/network.hpp"
#include "variants/trial.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

constexpr double resolution = 1.1; ///< ranks whose measured speeds differ by less count as equal

NodeSpeed own_speed(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition, World& world,
                    const Fault& fault) {
  world.meet(); // ranks that share a memory compute together, as in the run
  NodeSpeed speed = measure_speed(setup, plugin, decomposition, world.rank());
  speed.at_once /= fault.slowdown();
  speed.stage_by_stage /= fault.slowdown();
  return speed;
}

Decomposition decomposition_of(const Setup& setup, const Distribution& asked, const Weights& weights) {
  return decomposition_for(setup.problem, asked.decomposition, asked.ranks, weights);
}

/// Every rank's speed on an equal share.
Weights measured_weights(const Setup& setup, const Plugin& plugin, const Decomposition& equal, World& world,
                         const Fault& fault) {
  const std::vector<double> speed = world.gather(own_speed(setup, plugin, equal, world, fault).at_once);
  const auto [least, most] = std::minmax_element(speed.begin(), speed.end());
  return {*most > resolution * *least ? speed : std::vector<double>{}, {}};
}

/// A team of threads computes all rows at once: there are no edges that could be done before the rest.
bool is_possible(const HaloStrategy& strategy, int threads) {
  return threads == 1 || strategy.is_every_stage || !strategy.is_overlapped;
}

void choose_strategy(const Setup& setup, const Plugin& plugin, World& world, const Fault& fault, Spread& spread) {
  const Network& network = spread.network = measure_network(world.comm());
  const NodeSpeed speed = own_speed(setup, plugin, spread.decomposition, world, fault);
  const int stages = setup.method.stages, reach = setup.problem.lattice.row_reach();
  const double element_bytes = double(field_count) * (setup.precision == Precision::f64 ? 8.0 : 4.0);
  double least = std::numeric_limits<double>::infinity();
  for (const HaloStrategy& strategy : halo_strategies()) {
    if (strategy.transport == HaloStrategy::Transport::shared && !world.is_one_node()) continue;
    if (!is_possible(strategy, setup.threads)) continue;
    const PartSize size =
        part_size(setup.problem, spread.decomposition, world.rank(), halo_depth(strategy, setup.method));
    HaloCost cost = halo_cost(size, part_times(size, strategy, stages, reach, speed), strategy, stages, element_bytes);
    if (world.is_one_node()) cost.hiding_s = 0; // the processors themselves copy the messages
    const double step_s = world.largest(predicted_step_s(strategy, cost, network));
    spread.halo_reason += fmt::format("{}{} {:.4g} us", spread.halo_reason.empty() ? "predicted step: " : ", ",
                                      strategy.name, 1e6 * step_s);
    if (step_s >= least) continue;
    least = step_s;
    spread.halo = &strategy;
  }
}

} // namespace

Spread spread(const Setup& setup, const Plugin& plugin, World& world, const Fault& fault) {
  const Distribution& asked = *setup.distribution;
  if (asked.ranks != world.ranks())
    throw InputError(fmt::format("--ranks {}: this job has {} ranks; give --ranks {}, or start it by dssbench alone",
                                 asked.ranks, world.ranks(), world.ranks()));
  Spread result;
  result.decomposition = decomposition_of(setup, asked, {});
  if (asked.is_measured && world.ranks() > 1)
    result.decomposition =
        decomposition_of(setup, asked, measured_weights(setup, plugin, result.decomposition, world, fault));
  if (asked.halo != "auto") {
    result.halo = find_halo_strategy(asked.halo);
    std::vector<std::string> known{"auto"};
    for (const HaloStrategy& strategy : halo_strategies()) known.emplace_back(strategy.name);
    if (result.halo == nullptr)
      throw InputError(fmt::format("--halo {}: unknown strategy; {}", asked.halo, nearest_name(asked.halo, known)));
    if (!is_possible(*result.halo, setup.threads))
      throw InputError(fmt::format("--halo {}: needs --threads 1; give deep", asked.halo));
  } else if (world.ranks() == 1) {
    result.halo = find_halo_strategy("deep");
  } else {
    choose_strategy(setup, plugin, world, fault, result);
  }
  return result;
}

} // namespace dss
