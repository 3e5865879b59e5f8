#pragma once
/// From the name of a scene to its parsed text: finds the file, parses it, applies --set, resolves
/// the parameters.
#include "solver/json/node.hpp"
#include "solver/scene/expression.hpp"

#include <map>
#include <string>
#include <vector>

namespace dss {

/// --set KEY=VALUE. KEY is a parameter, or the path to a scalar of the scene: "run.dt",
/// "bodies/0/constants/E".
struct Override {
  std::string key, value;
};

/// An override from a file: its value is a number, a text, or true or false.
/// @throws InputError with the place of the value
Override read_override(const std::string& key, const Node& value);

/// Text of a scene: parsed, with overrides applied, and the parameters that its numbers use. A text
/// "=expression" stands for a number; a text from --set needs no "=".
struct SceneText : JsonFile {
  Parameters parameters; ///< resolved
  Fields fields;         ///< functions of the place, by name
  /// JSON pointer -> the --set that changed this value.
  std::map<std::string, std::string> overrides;

  bool is_expression(const std::string& text, const std::string& pointer) const override;
  double evaluate(const std::string& text) const override;
  PlaceFunction function_of(const std::string& text) const override;
  const char* number_forms() const override { return "a number or \"=expression\""; }
  std::string changed_by(const std::string& pointer) const override;
};

/// Folder of the shipped scenes: $DSSBENCH_SCENES, else the source tree, else share/dssbench/scenes
/// beside the program's folder.
std::string scene_directory();

/// File of a scene: NAME.json in scene_directory(), where a name may have a folder (bodies/porous).
/// Any other name with a slash or ending in .json is a path.
/// @throws InputError, of a name without a slash with the nearest name
std::string scene_path(const std::string& name_or_path);

/// Parses a file, applies the overrides in order and resolves the parameters.
/// @throws InputError if a file cannot be read, is not JSON (with line and column) or has a key
///     twice, or if an override changes nothing
SceneText read_scene_text(const std::string& path, const std::vector<Override>& overrides);

} // namespace dss
