#include "experiments/runner/atlas/formula.hpp"

#include <filesystem>

namespace dss {
namespace {

std::string override_text(const JsonPlace& place) {
  const nlohmann::json& value = place.value();
  if (!value.is_string() && !value.is_number() && !value.is_boolean())
    place.fail("is not a number, a text, or true or false");
  return value.is_string() ? value.get<std::string>() : value.dump();
}

} // namespace

Formula::Formula(const JsonPlace& place) {
  const nlohmann::json& value = place.value();
  const std::string text = value.is_string() ? value.get<std::string>() : "";
  if (!value.is_number() && !(text.starts_with("=") && text.size() > 1))
    place.fail(fmt::format("{} is not a number or an expression \"=...\"", value.dump()));
  text_ = value.is_number() ? value.dump() : text.substr(1);
  place_ = place.where();
}

double Formula::operator()(const Parameters& parameters) const {
  try {
    return evaluate(text_, parameters);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place_, error.what()));
  }
}

std::vector<Formula> formulas(const JsonPlace& place) {
  std::vector<Formula> all;
  for (const JsonPlace& item : place.items()) all.emplace_back(item);
  if (all.empty()) place.fail("is empty; give at least one number");
  return all;
}

std::vector<std::vector<Override>> combinations(const JsonPlace& object, const std::string& key) {
  std::vector<std::vector<Override>> sets(1);
  if (!object.has(key)) return sets;
  const JsonPlace values = object[key];
  if (!values.value().is_object()) values.fail("is not an object of overrides, such as {\"n\": 10}");
  for (const auto& item : values.value().items()) {
    std::vector<std::vector<Override>> longer;
    for (const std::vector<Override>& set : sets)
      for (const JsonPlace& value : values[item.key()].items()) {
        longer.push_back(set);
        longer.back().push_back({item.key(), override_text(value)});
      }
    if (longer.empty()) values[item.key()].fail("is empty; give at least one value");
    sets = std::move(longer);
  }
  return sets;
}

std::string scene_beside(const std::string& study_path, const std::string& scene) {
  if (!scene.ends_with(".json")) return scene;
  return (std::filesystem::path(study_path).parent_path() / scene).string();
}

} // namespace dss
