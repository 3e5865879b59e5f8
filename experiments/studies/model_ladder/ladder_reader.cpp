#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/studies/model_ladder/ladder_study.hpp"

#include <algorithm>

namespace dss {
namespace {

std::vector<Model> read_models(ObjectNode& object, const std::string& key) {
  std::vector<Model> models;
  if (const auto node = object.find(key))
    for (const Node& item : node->items()) models.push_back(model_in(item));
  return models;
}

LadderScene read_ladder_scene(const Node& node, const std::string& path) {
  ObjectNode object(node);
  LadderScene scene;
  scene.scene = scene_beside(path, object.require("scene").name());
  scene.set = one_set(object, "set");
  if (const auto steps = object.find("steps")) scene.steps = steps->whole(1);
  if (const auto precision = object.find("precision"))
    scene.precision = name(precision_in(*precision));
  scene.ends_with = model_in(object.require("auto"));
  scene.fails = read_models(object, "fails");
  scene.suffices = read_models(object, "suffices");
  object.finish();
  return scene;
}

} // namespace

LadderStudy read_ladder(const StudyFile& file) {
  ObjectNode scale(file.scale), object(file.part("model_ladder"));
  LadderStudy ladder{file.name,
                     file.title,
                     file.scale_name,
                     object.name_or("variant", "auto"),
                     scale.positive_or("repeat_for", 0),
                     {}};
  const std::vector<std::string> left_out = scale.names_or("leave_out", {});
  const Node scenes = object.require("scenes");
  scale.finish();
  object.finish();
  for (const Node& item : scenes.items(1)) {
    const LadderScene scene = read_ladder_scene(item, file.path);
    const std::string name = ObjectNode(item).require("scene").name();
    if (std::ranges::find(left_out, name) != left_out.end()) continue;
    item.placed([&] { load_scene(scene.scene, scene.set); });
    ladder.scenes.push_back(scene);
  }
  return ladder;
}

} // namespace dss
