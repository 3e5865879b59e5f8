#include "experiments/runner/keyed_study.hpp"
#include "experiments/runner/model/ladder_study.hpp"
#include "experiments/runner/study_sets.hpp"

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

std::optional<LadderStudy> load_ladder(const std::string& study, const std::string& scale) {
  const auto opened = open_study(study, "model_ladder", scale);
  if (!opened) return {};
  opened->work.require_keys({"variant", "scenes"});
  opened->scale.require_keys({"repeat_for", "leave_out"});
  LadderStudy ladder{opened->name, opened->title, scale, "auto", 0, {}};
  if (opened->work.has("variant")) ladder.variant = opened->work["variant"].text();
  if (opened->scale.has("repeat_for")) ladder.repeat_for = opened->scale["repeat_for"].positive();
  std::vector<std::string> left_out;
  if (opened->scale.has("leave_out")) left_out = opened->scale["leave_out"].texts();
  for (const JsonPlace& item : opened->work["scenes"].items())
    if (std::ranges::find(left_out, item["scene"].text()) == left_out.end())
      ladder.scenes.push_back(read_ladder_scene(item, opened->path));
  return ladder;
}

} // namespace dss
