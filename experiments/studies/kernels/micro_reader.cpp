#include "experiments/base/cores.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/studies/kernels/micro_study.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

/// Whole numbers, with "cores" for as many threads as there are.
std::vector<int> thread_counts(const JsonPlace& place) {
  std::vector<int> counts;
  for (const JsonPlace& item : place.items()) {
    const int count = item.value() == "cores" ? usable_cores() : int(item.count(1));
    if (std::ranges::find(counts, count) == counts.end() && count <= usable_cores())
      counts.push_back(count);
  }
  return counts;
}

MicroSet read_micro_set(const JsonPlace& place) {
  place.require_keys({"kernels", "models", "precisions", "variants", "levels", "threads", "n"});
  const auto texts = [&](const char* key) {
    return place.has(key) ? place[key].texts() : std::vector<std::string>{"*"};
  };
  MicroSet set{texts("kernels"),
               texts("models"),
               texts("precisions"),
               texts("variants"),
               texts("levels"),
               {1},
               {}};
  if (place.has("threads")) set.threads = thread_counts(place["threads"]);
  if (place.has("n"))
    for (const JsonPlace& n : place["n"].items()) set.sizes.push_back(int(n.count(2)));
  return set;
}

void read_attribution(const JsonPlace& place, std::vector<AttributionCase>& cases) {
  place.require_keys({"variants", "models", "precisions", "n"});
  for (const std::string& variant : place["variants"].texts())
    for (const JsonPlace& model : place["models"].items())
      for (const JsonPlace& precision : place["precisions"].items())
        for (const JsonPlace& n : place["n"].items())
          cases.push_back({variant, model_in(model), precision_in(precision), int(n.count(2))});
}

} // namespace

MicroStudy read_micro_study(const StudyFile& file) {
  file.scale.require_keys(
      {"repetitions", "sample_s", "attribution_rounds", "attribution_sample_s", "ceilings"});
  file.root["microbenchmarks"].require_keys({"sets", "attribution"});
  MicroStudy micro;
  micro.name = file.name, micro.title = file.title, micro.scale = file.scale_name;
  micro.rules = {int(file.scale["repetitions"].count(1)), file.scale["sample_s"].positive()};
  micro.attribution_rounds = int(file.scale["attribution_rounds"].count(1));
  micro.attribution_sample_s = file.scale["attribution_sample_s"].positive();
  if (file.scale.has("ceilings")) micro.has_ceilings = file.scale["ceilings"].flag();
  for (const JsonPlace& set : file.root["microbenchmarks"]["sets"].items())
    micro.sets.push_back(read_micro_set(set));
  if (file.root["microbenchmarks"].has("attribution"))
    for (const JsonPlace& place : file.root["microbenchmarks"]["attribution"].items())
      read_attribution(place, micro.attribution);
  return micro;
}

} // namespace dss
