#include "variants/mpi/spread.hpp"

#include "solver/decomposition/decomposition_file.hpp"
#include "variants/cost/trial.hpp"
#include "variants/mpi/rank_variant.hpp"
#include "variants/mpi/strategy_choice.hpp"

#include <algorithm>

namespace dss {
namespace {

constexpr double resolution = 1.1; ///< speeds within this factor count as equal

/// Calls `measure`, which exchanges nothing but may take long if a device compiles first.
template <class Measure>
auto measured_alone(World& world, Measure&& measure) {
  world.meet(); // ranks that share memory measure at the same time, as they compute in the run
  world.work_alone(true);
  const auto result = measure();
  world.work_alone(false);
  return result;
}

NodeSpeed own_speed(const Setup& setup, const Plugin& plugin, const Decomposition& decomposition,
                    World& world, const Fault& fault) {
  NodeSpeed speed = measured_alone(
      world, [&] { return measure_speed(setup, plugin, decomposition, world.rank()); });
  speed.at_once /= fault.slowdown();
  speed.stage_by_stage /= fault.slowdown();
  return speed;
}

Decomposition decomposition_of(const Setup& setup, const Distribution& asked,
                               const Weights& weights) {
  return decomposition_for(setup.problem, asked.decomposition, asked.ranks, weights);
}

/// Measures every rank's speed on an equal share. Empty weights if all speeds count as equal.
Weights measured_weights(const Setup& setup, const Plugin& plugin, const Decomposition& equal,
                         World& world, const Fault& fault) {
  const double own = measured_alone(
      world, [&] { return measure_speed_at_once(setup, plugin, equal, world.rank()); });
  const std::vector<double> speed = world.gather(own / fault.slowdown());
  const auto [least, most] = std::minmax_element(speed.begin(), speed.end());
  return {*most > resolution * *least ? speed : std::vector<double>{}, {}};
}

/// The weights of a hybrid's members, which ranks take in turn; empty if they have none.
Weights member_weights(const std::string& text, int ranks) {
  const std::vector<Member> members = parse_members(text);
  if (members.front().weight == 0) return {};
  Weights weights;
  for (int rank = 0; rank < ranks; ++rank)
    weights.speed.push_back(members[std::size_t(rank) % members.size()].weight);
  return weights;
}

} // namespace

Spread spread(const Setup& setup, const Plugin& plugin, World& world, const Fault& fault) {
  const Distribution& asked = *setup.distribution;
  require_ranks(asked, world);
  Spread result;
  const Weights given =
      setup.members.empty() ? Weights{} : member_weights(setup.members, asked.ranks);
  const bool is_measured = given.speed.empty() && (asked.is_measured || !setup.members.empty());
  result.decomposition = decomposition_of(setup, asked, given);
  if (is_measured && world.ranks() > 1)
    result.decomposition = decomposition_of(
        setup, asked, measured_weights(setup, plugin, result.decomposition, world, fault));
  if (asked.halo == "auto" && !setup.members.empty()) {
    result.halo = find_halo_strategy("deep");
    result.halo_reason = "members of a hybrid exchange once a step";
  } else if (asked.halo != "auto") {
    result.halo = &asked_halo_strategy(asked.halo, setup.threads);
  } else if (world.ranks() == 1) {
    result.halo = find_halo_strategy("deep");
  } else {
    const NodeSpeed speed = own_speed(setup, plugin, result.decomposition, world, fault);
    const StrategyChoice choice =
        choose_strategy(setup, plugin, result.decomposition, speed, world, fault);
    result.halo = choice.halo;
    result.halo_reason = choice.reason;
    result.network = choice.network;
  }
  return result;
}

} // namespace dss
