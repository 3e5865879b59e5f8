#include "experiments/runner/study_sets.hpp"
#include "solver/nearest_name.hpp"

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
  if (!overrides.value().is_object()) overrides.fail("is not an object of overrides, such as {\"n\": [50, 100]}");
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

Model model_in(const JsonPlace& place) {
  if (const auto model = find_model(place.text())) return *model;
  place.fail(fmt::format("unknown model \"{}\"; {}", place.text(), nearest_name(place.text(), model_names())));
}

Precision precision_in(const JsonPlace& place) {
  if (const auto precision = find_precision(place.text())) return *precision;
  std::vector<std::string> names;
  for (const Precision precision : precisions) names.emplace_back(name(precision));
  place.fail(fmt::format("unknown precision \"{}\"; {}", place.text(), nearest_name(place.text(), names)));
}

std::string scene_beside(const std::string& study_path, const std::string& scene) {
  if (!scene.ends_with(".json")) return scene;
  return (std::filesystem::path(study_path).parent_path() / scene).string();
}

} // namespace dss
