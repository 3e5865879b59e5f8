#include "experiments/measure/left_out.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/studies/cluster/cluster_study.hpp"
#include "variants/api/distribution.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr int most_ranks = 1024; // limit of the platform files

int rank_count(const std::string& text, const Node& node) {
  const int ranks = std::atoi(text.c_str());
  if (ranks < 1 || ranks > most_ranks || std::to_string(ranks) != text)
    node.fail(fmt::format("\"{}\" is not a number of ranks from 1 to {}", text, most_ranks));
  return ranks;
}

void read_problems(ObjectNode& object, SimulationBlock& block) {
  if (const auto weak = object.find("weak")) {
    for (const auto& [ranks, set] : ObjectNode(*weak).members()) {
      const int count = rank_count(ranks, *weak);
      block.set_of_ranks[count] = one_set(set);
      block.ranks.push_back(count);
    }
    std::ranges::sort(block.ranks);
    if (block.ranks.empty()) weak->fail("is empty; give overrides for each number of ranks");
    if (object.has("set") || object.has("ranks"))
      weak->fail("stands in place of \"set\" and \"ranks\"; leave them out");
    return;
  }
  block.sets = combinations(object, "set");
  for (const Node& item : object.require("ranks").list())
    block.ranks.push_back(int(item.whole(1, most_ranks)));
}

void read_choices(ObjectNode& object, SimulationBlock& block) {
  block.platforms = platforms_in(object.require("platforms"));
  block.halos =
      object.known_names_or("halos", "halo strategy of a simulation", simulated_halos(), {"auto"});
  block.decompositions = object.names_or("decompositions", {"strips"});
  for (const std::string& name : block.decompositions)
    if (const std::string why = why_no_decomposition(name); !why.empty())
      object.require("decompositions").fail(fmt::format("\"{}\": {}", name, why));
}

void read_published(ObjectNode& object, SimulationBlock& block) {
  if (const auto published = object.find("paper_node")) {
    ObjectNode node(*published);
    block.published =
        PublishedNode{node.require("wall_s").positive(), node.require("elements").positive(),
                      node.require("steps").positive()};
    node.finish();
  }
  const auto times = object.find("paper_wall_s");
  if (!times) return;
  for (const auto& [ranks, wall_s] : ObjectNode(*times).members())
    block.paper_wall_s[rank_count(ranks, *times)] = wall_s.positive();
  if (!block.paper_wall_s.contains(1))
    times->fail("lacks the time on 1 rank, which efficiencies refer to");
}

SimulationBlock read_block(const Node& node) {
  ObjectNode object(node);
  SimulationBlock block;
  block.label = object.require("label").name();
  block.scene = object.require("scene").name();
  block.steps = object.require("steps").whole(1);
  read_problems(object, block);
  read_choices(object, block);
  read_published(object, block);
  block.node_cores = int(object.whole_or("node_cores", 1, block.node_cores));
  for (const std::string& halo : block.halos)
    if (const HaloStrategy* strategy = find_halo_strategy(halo);
        strategy != nullptr && !strategy->is_possible(block.node_cores))
      object.require("halos").fail(
          fmt::format("\"{}\" is not possible on nodes of several cores", halo));
  object.finish();
  return block;
}

/// Finds mistakes in a scene. A large scene is read in full only when it is simulated, because that
/// takes seconds.
void require_sound(const std::string& scene, const std::vector<Override>& set) {
  constexpr double large = 1e6;
  if (scene_size(scene, set).cells < large) load_scene(scene, set);
}

/// Reads all blocks that the scale does not leave out.
std::vector<SimulationBlock> read_blocks(const Node& simulation, ObjectNode& scale) {
  LeftOut left_out(scale);
  std::vector<SimulationBlock> blocks;
  for (const Node& item : simulation.list()) {
    SimulationBlock block = read_block(item);
    if (left_out.has(block.label)) continue;
    for (const auto& set : block.sets) item.placed([&] { require_sound(block.scene, set); });
    blocks.push_back(std::move(block));
  }
  left_out.require_all_known("block of \"simulation\"");
  return blocks;
}

/// Removes problems that are too large for the scale.
void limit(ObjectNode& scale, std::vector<SimulationBlock>& blocks) {
  const long most_ranks_here = scale.whole_or("most_ranks", 1, most_ranks);
  const long most_elements = scale.whole_or("most_elements", 1, Node::most_whole);
  const bool is_limited = scale.has("most_elements");
  for (SimulationBlock& block : blocks) {
    std::erase_if(block.ranks, [&](int ranks) { return ranks > most_ranks_here; });
    if (!is_limited) continue;
    const auto is_large = [&](const std::vector<Override>& set) {
      const ShapeSize size = scene_size(block.scene, set);
      const auto most = double(most_elements);
      if (size.cells <= most || size.least_elements > most) return size.cells > most;
      return double(load_scene(block.scene, set).problem.lattice.element_count) > most;
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
  const bool is_alone = !ObjectNode(file.root).has("cells");
  ObjectNode scale(file.scale);
  std::vector<SimulationBlock> blocks = read_blocks(file.part("simulation"), scale);
  limit(scale, blocks);
  if (!is_alone) return blocks;
  scale.finish();
  if (blocks.empty()) scale.fail("leaves nothing to simulate");
  return blocks;
}

} // namespace dss
