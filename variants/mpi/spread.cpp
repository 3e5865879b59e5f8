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

double measure_step_s(const Setup& setup, const Plugin& plugin, const Part& part, const HaloStrategy& strategy,
                      const Fault& fault) {
  return measure_step_s(setup, plugin, part, strategy) * fault.slowdown();
}

int halo_depth(const HaloStrategy& strategy, const Method& method) {
  return strategy.is_every_stage ? 1 : method.stages;
}

Decomposition decomposition_of(const Setup& setup, const Distribution& asked, const Weights& weights) {
  return decomposition_for(setup.problem, asked.decomposition, asked.ranks, weights);
}

/// Every rank's speed in own elements a second, from an equal share.
Weights measured_weights(const Setup& setup, const Plugin& plugin, const Decomposition& equal, World& world,
                         const Fault& fault) {
  const HaloStrategy& deep = *find_halo_strategy("deep");
  const Part part = make_part(setup.problem, equal, world.rank(), halo_depth(deep, setup.method));
  world.meet();
  const double step_s = measure_step_s(setup, plugin, part, deep, fault);
  const std::vector<double> speed = world.gather(double(part.own_elements) / step_s);
  const auto [least, most] = std::minmax_element(speed.begin(), speed.end());
  return {*most > resolution * *least ? speed : std::vector<double>{}, {}};
}

/// Share of a part's rows that read no halo: what is computed while messages are under way.
double inner_share(const Part& part) {
  std::size_t outer = 0;
  for (const Neighbour& neighbour : part.neighbours) outer += neighbour.send.size();
  return 1 - std::min(1.0, double(outer) / double(part.own_elements));
}

HaloCost cost_of(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition, World& world,
                 const HaloStrategy& strategy, const Fault& fault) {
  const Part part = make_part(setup.problem, decomposition, world.rank(), halo_depth(strategy, setup.method));
  HaloCost cost;
  world.meet(); // ranks that share a memory compute together, as in the run
  cost.compute_s = measure_step_s(setup, plugin, part, strategy, fault);
  cost.hiding_s = cost.compute_s * inner_share(part);
  cost.exchanges = strategy.is_every_stage ? setup.method.stages : 1;
  cost.faces = int(part.neighbours.size());
  const std::size_t number = setup.precision == Precision::f64 ? 8 : 4;
  for (const Neighbour& neighbour : part.neighbours) cost.bytes += double(neighbour.send.size() * field_count * number);
  return cost;
}

void choose_strategy(const Setup& setup, const Plugin& plugin, World& world, const Fault& fault, Spread& spread) {
  const Network& network = spread.network = measure_network(world.comm());
  double least = std::numeric_limits<double>::infinity();
  for (const HaloStrategy& strategy : halo_strategies()) {
    if (strategy.transport == HaloStrategy::Transport::shared && !world.is_one_node()) continue;
    const HaloCost cost = cost_of(setup, plugin, spread.decomposition, world, strategy, fault);
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
  } else if (world.ranks() == 1) {
    result.halo = find_halo_strategy("deep");
  } else {
    choose_strategy(setup, plugin, world, fault, result);
  }
  return result;
}

} // namespace dss
