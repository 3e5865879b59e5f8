#include "experiments/measure/study_sets.hpp"
#include "solver/scene/scene_text.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace dss {
Sets combinations(const Node& overrides) {
  Sets sets(1);
  if (!overrides.is_object())
    overrides.fail("is not an object of overrides, such as {\"n\": [50, 100]}");
  for (const auto& [key, values] : ObjectNode(overrides).members()) {
    Sets longer;
    for (const std::vector<Override>& set : sets)
      for (const Node& value : values.list()) {
        longer.push_back(set);
        longer.back().push_back(read_override(key, value));
      }
    sets = std::move(longer);
  }
  return sets;
}

Sets combinations(ObjectNode& object, const std::string& key) {
  const auto overrides = object.find(key);
  return overrides ? combinations(*overrides) : Sets(1);
}

std::vector<Override> one_set(const Node& overrides) {
  const Sets sets = combinations(overrides);
  if (sets.size() != 1) overrides.fail("has several values for a key; give one each");
  return sets.front();
}

std::vector<Override> one_set(ObjectNode& object, const std::string& key) {
  const auto overrides = object.find(key);
  return overrides ? one_set(*overrides) : std::vector<Override>{};
}

std::string scene_beside(const std::string& study_path, const std::string& scene) {
  if (!scene.ends_with(".json")) return scene;
  const std::filesystem::path beside = std::filesystem::path(study_path).parent_path() / scene;
  const std::filesystem::path shipped = std::filesystem::path(scene_directory()) / scene;
  return std::filesystem::exists(shipped) && !std::filesystem::exists(beside) ? shipped.string()
                                                                              : beside.string();
}

} // namespace dss
