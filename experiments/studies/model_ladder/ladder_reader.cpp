#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/studies/model_ladder/ladder_study.hpp"

#include <algorithm>

namespace dss {
namespace {

LadderScene read_ladder_scene(const JsonPlace& place, const std::string& path) {
  place.require_keys({"scene", "set", "steps", "precision", "auto", "fails", "suffices"});
  LadderScene scene;
  scene.scene = scene_beside(path, place["scene"].text());
  if (place.has("set")) scene.set = one_set(place["set"]);
  if (place.has("steps")) scene.steps = place["steps"].count(1);
  if (place.has("precision")) scene.precision = name(precision_in(place["precision"]));
  scene.ends_with = model_in(place["auto"]);
  const auto read_models = [&](const char* key, std::vector<Model>& list) {
    if (place.has(key))
      for (const JsonPlace& item : place[key].items()) list.push_back(model_in(item));
  };
  read_models("fails", scene.fails);
  read_models("suffices", scene.suffices);
  try {
    load_scene(scene.scene, scene.set);
  } catch (const InputError& error) {
    place.fail(error.what());
  }
  return scene;
}

} // namespace

LadderStudy read_ladder(const StudyFile& file) {
  file.root["model_ladder"].require_keys({"variant", "scenes"});
  file.scale.require_keys({"repeat_for", "leave_out"});
  LadderStudy ladder{file.name, file.title, file.scale_name, "auto", 0, {}};
  if (file.root["model_ladder"].has("variant"))
    ladder.variant = file.root["model_ladder"]["variant"].text();
  if (file.scale.has("repeat_for")) ladder.repeat_for = file.scale["repeat_for"].positive();
  std::vector<std::string> left_out;
  if (file.scale.has("leave_out")) left_out = file.scale["leave_out"].texts();
  for (const JsonPlace& item : file.root["model_ladder"]["scenes"].items())
    if (std::ranges::find(left_out, item["scene"].text()) == left_out.end())
      ladder.scenes.push_back(read_ladder_scene(item, file.path));
  return ladder;
}

} // namespace dss
