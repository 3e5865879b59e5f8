#include "experiments/measure/kernels/working_set.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/studies/kernels/micro_study.hpp"
#include "solver/cores.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

/// Whole numbers, with "cores" for as many threads as there are.
std::vector<int> thread_counts(const Node& node) {
  std::vector<int> counts;
  for (const Node& item : node.list()) {
    const int count = item.json() == "cores" ? usable_cores() : item.count(1);
    if (std::ranges::find(counts, count) == counts.end() && count <= usable_cores())
      counts.push_back(count);
  }
  return counts;
}

MicroSet read_micro_set(const Node& node) {
  ObjectNode object(node);
  const std::vector<std::string> all{"*"};
  const auto known = [&](const char* key, const char* what, std::vector<std::string> names) {
    names.emplace_back("*");
    return object.known_names_or(key, what, names, all);
  };
  MicroSet set{object.names_or("kernels", all),
               known("models", "model", model_names()),
               known("precisions", "precision", {"f64", "f32"}),
               object.names_or("variants", all),
               known("levels", "level", memory_levels),
               {1},
               {}};
  if (const auto threads = object.find("threads")) set.threads = thread_counts(*threads);
  if (const auto sizes = object.find("n")) set.sizes = sizes->counts(2);
  object.finish();
  return set;
}

void read_attribution(const Node& node, std::vector<AttributionCase>& cases) {
  ObjectNode object(node);
  object.must_have({"variants", "models", "precisions", "n"});
  for (const std::string& variant : object.require("variants").names())
    for (const Node& model : object.require("models").list())
      for (const Node& precision : object.require("precisions").list())
        for (const int n : object.require("n").counts(2))
          cases.push_back({variant, model_in(model), precision_in(precision), n});
  object.finish();
}

} // namespace

MicroStudy read_micro_study(const StudyFile& file) {
  ObjectNode scale(file.scale), object(file.part("microbenchmarks"));
  MicroStudy micro;
  micro.name = file.name, micro.title = file.title, micro.scale = file.scale_name;
  micro.path = file.path;
  micro.rules = {scale.require("repetitions").count(1), scale.require("sample_s").positive()};
  micro.attribution_rounds = scale.require("attribution_rounds").count(1);
  micro.attribution_sample_s = scale.require("attribution_sample_s").positive();
  micro.has_ceilings = scale.flag_or("ceilings", micro.has_ceilings);
  scale.finish();
  for (const Node& set : object.require("sets").items(1)) micro.sets.push_back(read_micro_set(set));
  if (const auto attribution = object.find("attribution"))
    for (const Node& item : attribution->items(1)) read_attribution(item, micro.attribution);
  object.finish();
  return micro;
}

} // namespace dss
