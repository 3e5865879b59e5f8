#include "experiments/base/cores.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/studies/chain/chain_study.hpp"
#include "solver/numerics/method.hpp"
#include "variants/loading/loader.hpp"

namespace dss {
namespace {

/// Reads the values that a stage names; it keeps the other values of the stage before.
void read_link(const JsonPlace& place, ChainLink& link) {
  place.require_keys(
      {"label", "variant", "model", "precision", "integrator", "steps_an_interval", "threads"});
  if (place.has("label")) link.label = place["label"].text();
  if (place.has("variant")) link.variant = load_variant(place["variant"].text()).name;
  if (place.has("model")) link.model = model_in(place["model"]);
  if (place.has("precision")) link.precision = precision_in(place["precision"]);
  if (place.has("integrator")) {
    link.integrator = place["integrator"].text();
    const Method* method = find_method(link.integrator);
    if (method == nullptr || method->has_error_stage)
      place["integrator"].fail("is not a method of equal steps; `dssbench list methods` shows all");
  }
  if (place.has("steps_an_interval")) link.steps_an_interval = place["steps_an_interval"].count(1);
  if (place.has("threads"))
    link.threads =
        place["threads"].value() == "cores" ? usable_cores() : int(place["threads"].count(1));
}

} // namespace

ChainStudy read_chain(const StudyFile& file) {
  file.scale.require_keys({"set", "end_time", "repetitions", "sample_s"});
  const JsonPlace& work = file.root["chain"];
  work.require_keys({"scene", "set", "end_time", "saved_times", "bar", "solution", "links"});
  ChainStudy chain;
  chain.name = file.name, chain.title = file.title, chain.scale = file.scale_name;
  chain.scene = scene_beside(file.path, work["scene"].text());
  const JsonPlace& set = file.scale.has("set") ? file.scale : work;
  if (set.has("set")) chain.set = one_set(set["set"]);
  chain.end_time = (file.scale.has("end_time") ? file.scale : work)["end_time"].positive();
  chain.saved_times = int(work["saved_times"].count(1));
  chain.bar = work["bar"].positive();
  chain.repetitions = int(file.scale["repetitions"].count(1));
  chain.sample_s = file.scale["sample_s"].positive();
  ChainLink link{
      "", load_variant("auto").name, "rk4", Model::spatial, Precision::f64, usable_cores(), 0};
  chain.solution = link;
  read_link(work["solution"], chain.solution);
  if (chain.solution.steps_an_interval < 2)
    work["solution"].fail("names fewer than two steps_an_interval");
  for (const JsonPlace& place : work["links"].items()) {
    read_link(place, link);
    chain.links.push_back(link);
  }
  if (chain.links.size() < 2) work["links"].fail("has fewer than two links");
  for (const ChainLink& one : chain.links)
    if (one.steps_an_interval == 0) work["links"].fail("the first link names no steps_an_interval");
  return chain;
}

} // namespace dss
