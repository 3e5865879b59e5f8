#include "variants/mpi/rank_variant.hpp"

#include "solver/error.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {

/// Each text once, in the order of ranks, separated by commas.
static std::string joined(const std::vector<std::string>& texts) {
  std::vector<std::string> distinct;
  for (const std::string& text : texts)
    if (std::ranges::find(distinct, text) == distinct.end()) distinct.push_back(text);
  return fmt::format("{}", fmt::join(distinct, ","));
}

const Distribution& distribution_of(const Setup& setup) {
  static const Distribution alone;
  return setup.distribution == nullptr ? alone : *setup.distribution;
}

const Plugin& rank_plugin(Setup& setup, const World& world) {
  std::string variant = distribution_of(setup).variant;
  if (!setup.members.empty()) {
    if (setup.members == "auto")
      throw InputError(
          "--hybrid auto chooses among executors of one process; name the members of ranks");
    const std::vector<Member> members = parse_members(setup.members);
    const Member& own = members[std::size_t(world.rank()) % members.size()];
    variant = own.variant;
    setup.device = own.device;
    setup.threads = own.threads;
  }
  const Plugin& plugin = load_variant(variant);
  if (plugin.is_distributed)
    throw InputError(fmt::format("variant mpi:{}: a part cannot be distributed again", variant));
  require_terms(plugin, setup.problem);
  return plugin;
}

RankInfo info_of_ranks(const Plugin& own, World& world) {
  RankInfo info;
  info.ranks = world.ranks();
  info.variant = joined(world.gather(std::string(own.name)));
  info.isa = joined(world.gather(std::string(own.isa)));
  info.has_fma = world.least(own.has_fma) > 0;
  return info;
}

void require_ranks(const Distribution& asked, const World& world) {
  if (asked.ranks != world.ranks())
    throw InputError(fmt::format(
        "--ranks {}: this job has {} ranks; give --ranks {}, or start it by dssbench alone",
        asked.ranks, world.ranks(), world.ranks()));
}

} // namespace dss
