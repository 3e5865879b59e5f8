#include "experiments/measure/study_names.hpp"
#include "experiments/studies/chain/chain_study.hpp"
#include "solver/cores.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

/// Reads the values that a stage names; it keeps the other values of the stage before.
void read_stage(const Node& node, ChainStage& stage) {
  ObjectNode object(node);
  stage.label = object.name_or("label", stage.label);
  if (const auto variant = object.find("variant"))
    stage.variant = load_variant(variant->name()).name;
  if (const auto model = object.find("model")) stage.model = model_in(*model);
  if (const auto precision = object.find("precision")) stage.precision = precision_in(*precision);
  if (const auto integrator = object.find("integrator")) {
    stage.integrator = integrator->name();
    const Method* method = find_method(stage.integrator);
    if (method == nullptr || method->has_error_stage || method->is_exponential)
      integrator->fail("is not a method of equal steps; `dssbench list methods` shows all");
  }
  stage.steps_an_interval = object.whole_or("steps_an_interval", 1, stage.steps_an_interval);
  if (const auto threads = object.find("threads"))
    stage.threads = threads->json() == "cores" ? usable_cores() : threads->count(1);
  if (const auto smoothing = object.find("smoothing")) {
    const Method* method = find_method(stage.integrator);
    if (!method->is_staggered()) smoothing->fail("is of a leapfrog; this stage has another method");
    stage.smoothing = smoothing->non_negative();
  }
  object.allow({"of"});
  object.finish();
}

/// A neighbour has the values of its stage, except those that it names.
ChainNeighbour read_neighbour(const Node& node, const std::vector<ChainStage>& chain) {
  ObjectNode object(node);
  const std::string of = object.require("of").name();
  const auto stage = std::ranges::find(chain, of, &ChainStage::label);
  if (stage == chain.end())
    object.require("of").fail(fmt::format("no stage has the label \"{}\"", of));
  ChainNeighbour neighbour{std::size_t(stage - chain.begin()), *stage};
  neighbour.stage.steps_an_interval = 0;
  read_stage(node, neighbour.stage);
  return neighbour;
}

} // namespace

std::vector<ChainStage> ChainStudy::timed() const {
  std::vector<ChainStage> all = stages;
  for (const ChainNeighbour& neighbour : neighbours) all.push_back(neighbour.stage);
  return all;
}

Method method_of(const ChainStage& stage) {
  Method method = *find_method(stage.integrator);
  if (stage.smoothing) {
    method.smoothing = *stage.smoothing;
    method.real_limit = 1 + *stage.smoothing;
  }
  return method;
}

ChainStudy read_chain(const StudyFile& file) {
  ObjectNode scale(file.scale), object(file.part("chain"));
  ChainStudy chain;
  chain.name = file.name, chain.title = file.title, chain.scale = file.scale_name;
  chain.path = file.path;
  chain.scene = scene_beside(file.path, object.require("scene").name());
  chain.set = one_set(object, "set");
  if (scale.has("set")) chain.set = one_set(scale, "set");
  chain.end_time = object.require("end_time").positive();
  chain.end_time = scale.positive_or("end_time", chain.end_time);
  chain.saved_times = object.require("saved_times").count(1);
  chain.bar = object.require("bar").positive();
  chain.repetitions = scale.require("repetitions").count(1);
  chain.samples = int(scale.whole_or("samples", 1, chain.samples));
  chain.sample_s = scale.require("sample_s").positive();
  chain.error_s = scale.positive_or("error_s", chain.error_s);
  scale.finish();
  ChainStage stage;
  stage.variant = load_variant("auto").name;
  stage.integrator = "rk4";
  stage.threads = usable_cores();
  chain.solution = stage;
  const Node solution = object.require("solution"), stages = object.require("stages");
  const auto neighbours = object.find("neighbours");
  object.finish();
  read_stage(solution, chain.solution);
  if (chain.solution.steps_an_interval < 2) solution.fail("names fewer than two steps_an_interval");
  for (const Node& item : stages.items(2)) {
    read_stage(item, stage);
    chain.stages.push_back(stage);
  }
  if (chain.stages[0].steps_an_interval == 0)
    stages.fail("the first stage names no steps_an_interval");
  if (neighbours)
    for (const Node& item : neighbours->items(1))
      chain.neighbours.push_back(read_neighbour(item, chain.stages));
  return chain;
}

} // namespace dss
