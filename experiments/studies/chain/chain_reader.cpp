#include "experiments/base/cores.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/studies/chain/chain_study.hpp"
#include "solver/numerics/method.hpp"
#include "variants/loading/loader.hpp"

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
    if (method == nullptr || method->has_error_stage)
      integrator->fail("is not a method of equal steps; `dssbench list methods` shows all");
  }
  stage.steps_an_interval = object.whole_or("steps_an_interval", 1, stage.steps_an_interval);
  if (const auto threads = object.find("threads"))
    stage.threads = threads->json() == "cores" ? usable_cores() : threads->count(1);
  object.finish();
}

} // namespace

ChainStudy read_chain(const StudyFile& file) {
  ObjectNode scale(file.scale), object(file.part("chain"));
  ChainStudy chain;
  chain.name = file.name, chain.title = file.title, chain.scale = file.scale_name;
  chain.scene = scene_beside(file.path, object.require("scene").name());
  chain.set = one_set(object, "set");
  if (scale.has("set")) chain.set = one_set(scale, "set");
  chain.end_time = object.require("end_time").positive();
  chain.end_time = scale.positive_or("end_time", chain.end_time);
  chain.saved_times = object.require("saved_times").count(1);
  chain.bar = object.require("bar").positive();
  chain.repetitions = scale.require("repetitions").count(1);
  chain.sample_s = scale.require("sample_s").positive();
  scale.finish();
  ChainStage stage{
      "", load_variant("auto").name, "rk4", Model::spatial, Precision::f64, usable_cores(), 0};
  chain.solution = stage;
  const Node solution = object.require("solution"), stages = object.require("stages");
  object.finish();
  read_stage(solution, chain.solution);
  if (chain.solution.steps_an_interval < 2) solution.fail("names fewer than two steps_an_interval");
  for (const Node& item : stages.items(2)) {
    read_stage(item, stage);
    chain.stages.push_back(stage);
  }
  if (chain.stages[0].steps_an_interval == 0)
    stages.fail("the first stage names no steps_an_interval");
  return chain;
}

} // namespace dss
