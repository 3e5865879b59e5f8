#include "solver/scene/scene_text.hpp"

#include "solver/error.hpp"
#include "solver/io/program_files.hpp"
#include "solver/json/object_node.hpp"
#include "solver/json/parse.hpp"
#include "solver/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace dss {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Value of --set: a JSON scalar, or a text for anything else (a name, or an expression where a
/// number is expected).
json scalar_of(const Override& change) {
  const json value = json::parse(change.value, nullptr, false);
  if (value.is_discarded()) return change.value;
  if (value.is_primitive() && !value.is_null()) return value;
  throw InputError(fmt::format("--set {}={}: the value must be a number, a text or true or false",
                               change.key, change.value));
}

std::vector<std::string> keys_of(const json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

[[noreturn]] void fail_override(const Override& change, const std::string& message) {
  throw InputError(fmt::format("--set {}={}: {}", change.key, change.value, message));
}

/// Member of an object, created if it is missing (the reader refuses unknown keys later), or item
/// of an array.
json& step_into(json& parent, const std::string& part, const Override& change) {
  const bool is_index =
      !part.empty() && part.size() < 10 &&
      std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  // Every vector that may be absent has this default.
  if (parent.is_null() && is_index) parent = {0, 0, 0};
  if (parent.is_object() || parent.is_null()) return parent[part];
  if (parent.is_array() && is_index && std::stoul(part) < parent.size())
    return parent[std::stoul(part)];
  if (parent.is_array())
    fail_override(change, fmt::format("\"{}\" is not an index of its array; it has items 0 to {}",
                                      part, int(parent.size()) - 1));
  fail_override(change,
                fmt::format("the scene has a single value where \"{}\" is looked for", part));
}

/// @return the JSON pointer of what was changed
std::string apply(json& root, const Override& change) {
  std::string path = change.key, pointer;
  std::replace(path.begin(), path.end(), '.', '/');
  const bool has_parameters = root.contains("parameters") && root["parameters"].is_object();
  if (has_parameters && root["parameters"].contains(path)) path = "parameters/" + path;
  if (path.find('/') == std::string::npos && !root.contains(path)) {
    const std::vector<std::string> known =
        has_parameters ? keys_of(root["parameters"]) : std::vector<std::string>();
    fail_override(
        change,
        fmt::format(
            "the scene has no parameter \"{}\"; {}; other scalars are named by their path, as "
            "in run.dt",
            path, known.empty() ? "it has none" : nearest_name(path, known)));
  }
  json* place = &root;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '/');) {
    if (part.empty()) continue;
    place = &step_into(*place, part, change);
    pointer += "/" + part;
  }
  if (place->is_structured())
    fail_override(change, fmt::format("{} is not a scalar; name one inside it", pointer));
  *place = scalar_of(change);
  return pointer;
}

bool is_identifier(const std::string& name) {
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

/// An expression without the sign that marks it.
std::string without_sign(const std::string& text) {
  return text.substr(text.starts_with('=') ? 1 : 0);
}

/// Reports parameters that cannot be evaluated: one of them has a fault, or they refer to each
/// other.
[[noreturn]] void fail_unresolved(SceneText& text, ObjectNode& names,
                                  const std::vector<std::string>& pending) {
  // With any value for these, a parameter that only depends on others resolves.
  for (const std::string& name : pending) text.parameters[name] = 1;
  for (const std::string& name : pending) names.require(name).number();
  names.require(pending.front())
      .fail(
          fmt::format("refers to itself; parameters must not form a circle: {}", listed(pending)));
}

/// Parameters may refer to each other in any order. Each pass resolves those whose references are
/// resolved.
void resolve_parameters(SceneText& text) {
  ObjectNode root{Node(text)};
  const std::optional<Node> parameters = root.find("parameters");
  if (!parameters) return;
  ObjectNode names(*parameters);
  std::vector<std::string> pending = keys_of(parameters->json());
  for (const std::string& name : pending)
    if (!is_identifier(name) || name == "pi")
      names.require(name).fail(
          fmt::format("\"{}\" cannot name a parameter; use letters, digits and _{}", name,
                      name == "pi" ? "; pi is a constant" : ""));
  while (!pending.empty()) {
    const std::size_t before = pending.size();
    std::erase_if(pending, [&](const std::string& name) {
      const Node node = names.require(name);
      try {
        text.parameters[name] = node.number();
        return true;
      } catch (const InputError&) {
        return false;
      }
    });
    if (pending.size() < before) continue;
    fail_unresolved(text, names, pending);
  }
}

/// "fields": names for functions of the place.
void read_fields(SceneText& text) {
  ObjectNode root{Node(text)};
  const std::optional<Node> given = root.find("fields");
  if (!given) return;
  ObjectNode names(*given);
  for (const auto& [name, node] : names.members()) {
    if (!is_identifier(name) || text.parameters.contains(name) || name == "pi" || name == "x" ||
        name == "y" || name == "z")
      node.fail(fmt::format("\"{}\" cannot name a field; use letters, digits and _, and no name of "
                            "a parameter, coordinate or constant",
                            name));
    const std::string expression = without_sign(node.text());
    if (!function_of_place(expression, text.parameters, {}))
      node.fail(fmt::format("\"={}\" is not an expression over the place x, y, z and the scene's "
                            "parameters",
                            expression));
    text.fields[name] = expression;
  }
}

std::vector<std::string> scene_names(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace

Override read_override(const std::string& key, const Node& value) {
  if (value.json().is_null() || value.json().is_structured())
    value.fail(value.shown() + " is not a number, a text, or true or false");
  return {key, value.is_string() ? value.text() : value.json().dump()};
}

std::string scene_directory() {
  if (const char* chosen = std::getenv("DSSBENCH_SCENES"); chosen != nullptr && *chosen != '\0')
    return chosen;
  return program_file("experiments/scenes").string();
}

std::string scene_path(const std::string& name_or_path) {
  std::error_code error;
  const std::string directory = scene_directory();
  const std::string path = fmt::format("{}/{}.json", directory, name_or_path);
  if (!name_or_path.empty() && fs::exists(path, error)) return path;
  if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".json")) {
    if (!fs::exists(name_or_path, error))
      throw InputError(fmt::format(
          "{}: no such scene file; a name without \".json\" is looked for among the shipped "
          "scenes, see `dssbench list scenes`",
          name_or_path));
    return name_or_path;
  }
  const std::vector<std::string> names = scene_names(directory);
  if (names.empty())
    throw InputError(
        fmt::format("scene \"{}\": no scenes in {}; set DSSBENCH_SCENES to their directory",
                    name_or_path, directory));
  throw InputError(fmt::format("scene \"{}\": no such scene; {}", name_or_path,
                               nearest_name(name_or_path, names)));
}

bool SceneText::is_expression(const std::string& text, const std::string& pointer) const {
  return text.starts_with('=') || overrides.contains(pointer);
}

double SceneText::evaluate(const std::string& text) const {
  try {
    return dss::evaluate(without_sign(text), parameters);
  } catch (const InputError& error) {
    std::vector<std::string> known;
    for (const auto& item : parameters) known.push_back(item.first);
    throw InputError(
        fmt::format("{}; parameters are {}", error.what(), known.empty() ? "none" : listed(known)));
  }
}

PlaceFunction SceneText::function_of(const std::string& text) const {
  return function_of_place(without_sign(text), parameters, fields);
}

std::string SceneText::changed_by(const std::string& pointer) const {
  const auto change = overrides.find(pointer);
  return change == overrides.end() ? "" : change->second;
}

SceneText read_scene_text(const std::string& path, const std::vector<Override>& overrides) {
  SceneText text;
  text.path = path;
  text.root = parse_json_file(path);
  if (!text.root.is_object())
    throw InputError(fmt::format("{}: a scene is a JSON object {{...}}", path));
  for (const Override& change : overrides)
    text.overrides[apply(text.root, change)] = fmt::format("--set {}={}", change.key, change.value);
  resolve_parameters(text);
  read_fields(text);
  return text;
}

} // namespace dss
