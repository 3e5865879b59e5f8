#include "experiments/measure/solution_rule.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/studies/advise/advise_study.hpp"

#include <algorithm>
#include <functional>

namespace dss {
namespace {

/// Reads all but the scene itself.
AdviseStudy::Case read_case(const Node& node, double shorten, const std::string& file) {
  ObjectNode object(node);
  AdviseStudy::Case of;
  of.scene = scene_beside(file, object.require("scene").name());
  of.set = one_set(object, "set");
  if (const auto quantity = object.find("quantity"))
    of.quantity = *find_quantity(quantity->known_name("quantity", names_of("QUANTITY")));
  of.times = read_saved_times(object, shorten);
  object.finish();
  return of;
}

} // namespace

AdviseStudy read_advise(const StudyFile& file) {
  ObjectNode scale(file.scale), object(file.part("advise"));
  AdviseStudy study;
  study.name = file.name;
  study.title = file.title;
  study.scale = file.scale_name;
  study.solution = read_solution_rule(object);
  study.bar = object.positive_or("bar", study.bar);
  study.tolerances = object.require("tolerances").positives();
  if (const auto own = scale.find("tolerances")) study.tolerances = own->positives();
  std::ranges::sort(study.tolerances, std::greater());
  const double shorten = scale.positive_or("shorten", 1);
  const std::vector<std::string> chosen = scale.names_or("scenes", {});
  const Node scenes = object.require("scenes");
  scale.finish();
  object.finish();
  for (const Node& item : scenes.items(1)) {
    AdviseStudy::Case of = read_case(item, shorten, file.path);
    const std::string name = ObjectNode(item).require("scene").name();
    if (!chosen.empty() && std::ranges::find(chosen, name) == chosen.end()) continue;
    of.loaded = item.placed([&] { return load_scene(of.scene, of.set); });
    study.cases.push_back(std::move(of));
  }
  if (study.cases.empty()) scenes.fail("no scene is left");
  return study;
}

} // namespace dss
