#include "experiments/measure/study_sets.hpp"
#include "solver/scene/json/document.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace dss {
namespace {

std::string override_text(const JsonPlace& place) {
  const nlohmann::json& value = place.value();
  if (!value.is_string() && !value.is_number() && !value.is_boolean())
    place.fail(fmt::format("{} is not a number, a text, or true or false", value.dump()));
  return value.is_string() ? value.get<std::string>() : value.dump();
}

} // namespace

Sets combinations(const JsonPlace& overrides) {
  Sets sets(1);
  if (!overrides.value().is_object())
    overrides.fail("is not an object of overrides, such as {\"n\": [50, 100]}");
  for (const auto& item : overrides.value().items()) {
    Sets longer;
    for (const std::vector<Override>& set : sets)
      for (const JsonPlace& value : overrides[item.key()].items()) {
        longer.push_back(set);
        longer.back().push_back({item.key(), override_text(value)});
      }
    if (longer.empty()) overrides[item.key()].fail("is empty; give at least one value");
    sets = std::move(longer);
  }
  return sets;
}

Sets combinations(const JsonPlace& object, const std::string& key) {
  return object.has(key) ? combinations(object[key]) : Sets(1);
}

std::vector<Override> one_set(const JsonPlace& overrides) {
  const Sets sets = combinations(overrides);
  if (sets.size() != 1) overrides.fail("has several values for a key; give one each");
  return sets.front();
}

std::string scene_beside(const std::string& study_path, const std::string& scene) {
  if (!scene.ends_with(".json")) return scene;
  const std::filesystem::path beside = std::filesystem::path(study_path).parent_path() / scene;
  const std::filesystem::path shipped = std::filesystem::path(scene_directory()) / scene;
  return std::filesystem::exists(shipped) && !std::filesystem::exists(beside) ? shipped.string()
                                                                              : beside.string();
}

} // namespace dss
