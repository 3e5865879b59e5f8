#include "experiments/measure/left_out.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/run/cluster/simulation.hpp"
#include "experiments/studies/mixed_nodes/mixed_study.hpp"
#include "variants/api/distribution.hpp"

namespace dss {
namespace {

constexpr int most_nodes = 1024; // limit of the platform files

void read_nodes(const Node& nodes, MixedStudy& study) {
  for (const auto& [name, published] : ObjectNode(nodes).members()) {
    ObjectNode node(published);
    const double wall_s = node.require("wall_s").positive();
    const double elements = node.require("elements").positive();
    study.speeds[name] = elements * node.require("steps").positive() / wall_s;
    node.finish();
  }
  if (study.speeds.empty()) nodes.fail("is empty; give a kind of node");
}

NodeMix read_mix(const Node& item, const MixedStudy& study) {
  NodeMix mix;
  int nodes = 0;
  for (const auto& [kind, count] : ObjectNode(item).members()) {
    if (!study.speeds.contains(kind)) item.fail("\"" + kind + "\" is no kind of \"nodes\"");
    nodes += mix[kind] = int(count.whole(1, most_nodes));
  }
  if (nodes == 0 || nodes > most_nodes)
    item.fail("has " + std::to_string(nodes) + " nodes; give 1 to " + std::to_string(most_nodes));
  return mix;
}

MixedCase read_case(const Node& item, const MixedStudy& study) {
  ObjectNode object(item);
  MixedCase one;
  one.label = object.require("label").name();
  one.sets = combinations(object, "set");
  one.platforms = platforms_in(object.require("platforms"));
  one.halos =
      object.known_names_or("halos", "halo strategy of a simulation", simulated_halos(), {"auto"});
  for (const Node& mix : object.require("mixes").items(1))
    one.mixes.push_back(read_mix(mix, study));
  object.finish();
  for (const auto& set : one.sets) item.placed([&] { load_scene(study.scene, set); });
  return one;
}

void read_held(const Node& held, MixedStudy& study) {
  ObjectNode object(held);
  study.held_sets = combinations(object, "set");
  study.pairs = object.require("pairs").whole(1);
  object.finish();
  for (const auto& set : study.held_sets) held.placed([&] { load_scene(study.scene, set); });
}

} // namespace

MixedStudy read_mixed(const StudyFile& file) {
  ObjectNode object(file.part("mixed_nodes")), scale(file.scale);
  MixedStudy study;
  study.name = file.name;
  study.scene = object.require("scene").name();
  study.steps = object.require("steps").whole(1);
  read_nodes(object.require("nodes"), study);
  LeftOut left_out(scale);
  for (const Node& item : object.require("cases").items(1)) {
    MixedCase one = read_case(item, study);
    if (!left_out.has(one.label)) study.cases.push_back(std::move(one));
  }
  left_out.require_all_known("case");
  read_held(object.require("held"), study);
  study.pairs = scale.whole_or("pairs", 1, study.pairs);
  object.finish();
  scale.finish();
  return study;
}

} // namespace dss
