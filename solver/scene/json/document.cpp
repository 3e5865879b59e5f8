#include "solver/scene/json/document.hpp"

#include "solver/error.hpp"
#include "solver/io/program_files.hpp"
#include "solver/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace dss {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string file_content(const std::string& path) {
  if (fs::is_directory(path))
    throw InputError(fmt::format("{}: is a directory, not a scene file", path));
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (!file || !(content << file.rdbuf()))
    throw InputError(
        fmt::format("{}: cannot be read, or is empty; a scene is a readable JSON file", path));
  return content.str();
}

/// Line and column, both from 1, of a byte in the text.
std::pair<std::size_t, std::size_t> line_and_column(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + std::ptrdiff_t(std::min(byte, text.size()));
  const auto line = std::size_t(std::count(text.begin(), end, '\n'));
  const std::size_t line_start =
      line == 0 ? 0 : text.rfind('\n', std::size_t(end - text.begin()) - 1) + 1;
  return {line + 1, std::size_t(end - text.begin()) - line_start + 1};
}

/// Parses JSON and refuses a key that stands twice in an object. The library would silently keep
/// the last one.
json parse(const std::string& path, const std::string& text) {
  std::vector<std::set<std::string>> keys;
  std::string repeated;
  const auto watch_keys = [&](int, json::parse_event_t event, json& value) {
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second &&
        repeated.empty())
      repeated = value.get<std::string>();
    return true;
  };
  json root;
  try {
    root = json::parse(text, watch_keys);
  } catch (const json::parse_error& error) {
    const auto [line, column] = line_and_column(text, error.byte == 0 ? 0 : error.byte - 1);
    std::string detail = error.what();
    if (const auto place = detail.find("syntax error"); place != std::string::npos)
      detail = detail.substr(place);
    throw InputError(
        fmt::format("{}: line {}, column {}: not JSON: {}", path, line, column, detail));
  } catch (const json::exception& error) {
    throw InputError(fmt::format("{}: not usable JSON: {}", path, error.what()));
  }
  if (!repeated.empty())
    throw InputError(fmt::format("{}: key \"{}\" stands twice in one object", path, repeated));
  return root;
}

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
  ObjectNode root(Node(text, text.root, ""));
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

std::vector<std::string> scene_names(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace

std::string scene_directory() {
  if (const char* chosen = std::getenv("DSSBENCH_SCENES"); chosen != nullptr && *chosen != '\0')
    return chosen;
  return program_file("experiments/scenes").string();
}

std::string scene_path(const std::string& name_or_path) {
  std::error_code error;
  if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".json")) {
    if (!fs::exists(name_or_path, error))
      throw InputError(fmt::format(
          "{}: no such scene file; a name without \".json\" is looked for among the shipped "
          "scenes, see `dssbench list scenes`",
          name_or_path));
    return name_or_path;
  }
  const std::string directory = scene_directory();
  const std::string path = (fs::path(directory) / (name_or_path + ".json")).string();
  if (!name_or_path.empty() && fs::exists(path, error)) return path;
  const std::vector<std::string> names = scene_names(directory);
  if (names.empty())
    throw InputError(
        fmt::format("scene \"{}\": no scenes in {}; set DSSBENCH_SCENES to their directory",
                    name_or_path, directory));
  throw InputError(fmt::format("scene \"{}\": no such scene; {}", name_or_path,
                               nearest_name(name_or_path, names)));
}

SceneText read_scene_text(const std::string& path, const std::vector<Override>& overrides) {
  SceneText text;
  text.path = path;
  text.root = parse(path, file_content(path));
  if (!text.root.is_object())
    throw InputError(fmt::format("{}: a scene is a JSON object {{...}}", path));
  for (const Override& change : overrides)
    text.overrides[apply(text.root, change)] = fmt::format("--set {}={}", change.key, change.value);
  resolve_parameters(text);
  return text;
}

} // namespace dss
