#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/studies/cluster/cluster_study.hpp"
#include "solver/nearest_name.hpp"
#include "variants/api/distribution.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr int most_ranks = 1024; // limit of the platform files

int rank_count(const std::string& text, const JsonPlace& place) {
  const int ranks = std::atoi(text.c_str());
  if (ranks < 1 || ranks > most_ranks || std::to_string(ranks) != text)
    place.fail(fmt::format("\"{}\" is not a number of ranks from 1 to {}", text, most_ranks));
  return ranks;
}

void read_problems(const JsonPlace& place, SimulationBlock& block) {
  if (place.has("weak")) {
    for (const auto& [ranks, set] : place["weak"].value().items()) {
      const int count = rank_count(ranks, place["weak"]);
      block.set_of_ranks[count] = one_set(place["weak"][ranks]);
      block.ranks.push_back(count);
    }
    std::ranges::sort(block.ranks);
    if (block.ranks.empty())
      place["weak"].fail("is empty; give overrides for each number of ranks");
    return;
  }
  block.sets = combinations(place, "set");
  for (const JsonPlace& item : place["ranks"].items())
    block.ranks.push_back(rank_count(fmt::format("{}", item.count(1)), item));
}

void read_choices(const JsonPlace& place, SimulationBlock& block) {
  block.platforms = place["platforms"].texts();
  block.halos = place.has("halos") ? place["halos"].texts() : std::vector<std::string>{"auto"};
  block.decompositions = place.has("decompositions") ? place["decompositions"].texts()
                                                     : std::vector<std::string>{"strips"};
  for (const std::string& name : block.platforms) try {
      Platform::require_known(name);
    } catch (const InputError& error) {
      place["platforms"].fail(error.what());
    }
  std::vector<std::string> known{"auto"};
  for (const HaloStrategy& strategy : halo_strategies())
    if (strategy.transport != HaloStrategy::Transport::shared) known.emplace_back(strategy.name);
  for (const std::string& name : block.halos)
    if (std::ranges::find(known, name) == known.end())
      place["halos"].fail(
          fmt::format("\"{}\" cannot be simulated; {}", name, nearest_name(name, known)));
  for (const std::string& name : block.decompositions)
    if (const std::string why = why_no_decomposition(name); !why.empty())
      place["decompositions"].fail(fmt::format("\"{}\": {}", name, why));
}

SimulationBlock read_block(const JsonPlace& place) {
  place.require_keys({"label", "scene", "set", "weak", "ranks", "platforms", "halos",
                      "decompositions", "steps", "paper_node", "paper_wall_s"});
  SimulationBlock block;
  block.label = place["label"].text();
  block.scene = place["scene"].text();
  block.steps = place["steps"].count(1);
  read_problems(place, block);
  read_choices(place, block);
  if (place.has("paper_node")) {
    const JsonPlace node = place["paper_node"];
    node.require_keys({"wall_s", "elements", "steps"});
    block.published = PublishedNode{node["wall_s"].positive(), node["elements"].positive(),
                                    node["steps"].positive()};
  }
  if (place.has("paper_wall_s")) {
    for (const auto& [ranks, wall_s] : place["paper_wall_s"].value().items())
      block.paper_wall_s[rank_count(ranks, place["paper_wall_s"])] =
          place["paper_wall_s"][ranks].positive();
    if (!block.paper_wall_s.contains(1))
      place["paper_wall_s"].fail("lacks the time on 1 rank, which efficiencies refer to");
  }
  for (const auto& set : block.sets) try {
      load_scene(block.scene, set);
    } catch (const InputError& error) {
      place.fail(error.what());
    }
  return block;
}

/// Removes the blocks that a scale leaves out before they are read, because loading a large scene
/// takes seconds.
std::vector<JsonPlace> kept_blocks(const JsonPlace& simulation, const JsonPlace& scale) {
  std::vector<JsonPlace> kept = simulation.items();
  if (!scale.has("leave_out")) return kept;
  for (const JsonPlace& label : scale["leave_out"].items()) {
    std::vector<JsonPlace> rest;
    for (const JsonPlace& block : kept)
      if (block["label"].text() != label.text()) rest.push_back(block);
    if (rest.size() == kept.size())
      label.fail(fmt::format("no block of \"simulation\" has the label \"{}\"", label.text()));
    kept = std::move(rest);
  }
  return kept;
}

/// Removes problems that are too large for the scale.
void limit(const JsonPlace& scale, std::vector<SimulationBlock>& blocks) {
  const long most_ranks_here = scale.has("most_ranks") ? scale["most_ranks"].count(1) : most_ranks;
  for (SimulationBlock& block : blocks) {
    std::erase_if(block.ranks, [&](int ranks) { return ranks > most_ranks_here; });
    if (!scale.has("most_elements")) continue;
    const auto most = std::size_t(scale["most_elements"].count(1));
    const auto is_large = [&](const std::vector<Override>& set) {
      return load_scene(block.scene, set).problem.lattice.element_count > most;
    };
    std::erase_if(block.sets, is_large);
    std::erase_if(block.ranks, [&](int ranks) {
      return block.set_of_ranks.contains(ranks) && is_large(block.set_of_ranks.at(ranks));
    });
  }
  std::erase_if(blocks, [](const SimulationBlock& block) {
    return block.ranks.empty() || (block.set_of_ranks.empty() && block.sets.empty());
  });
}

} // namespace

std::vector<SimulationBlock> read_simulation(const StudyFile& file) {
  const bool is_alone = !file.root.has("cells");
  std::vector<SimulationBlock> blocks;
  for (const JsonPlace& block : kept_blocks(file.root["simulation"], file.scale))
    blocks.push_back(read_block(block));
  if (is_alone) file.scale.require_keys({"most_ranks", "most_elements", "leave_out"});
  limit(file.scale, blocks);
  if (blocks.empty() && is_alone) file.scale.fail("leaves nothing to simulate");
  return blocks;
}

} // namespace dss
