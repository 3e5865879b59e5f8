#pragma once
/// From a scene's name to its parsed text: finding the file, parsing it, applying --set, resolving the parameters.
#include "solver/scene/json/node.hpp"

#include <string>
#include <vector>

namespace dss {

/// --set KEY=VALUE. KEY is a parameter, or the path to a scalar of the scene: "run.dt", "bodies/0/constants/E".
struct Override {
  std::string key, value;
};

/// Where the shipped scenes are: $DSSBENCH_SCENES, else the source tree, else share/dssbench/scenes beside the
/// program's folder.
std::string scene_directory();

/// File of a scene. A name with a slash or ending in .json is a path, any other is looked up in scene_directory().
/// @throws InputError that suggests the nearest name
std::string scene_path(const std::string& name_or_path);

/// Parses a file, applies overrides in order and resolves the parameters.
/// @throws InputError for a file that cannot be read, is not JSON (with line and column), has a key twice, or for an
/// override that changes nothing in it
SceneText read_scene_text(const std::string& path, const std::vector<Override>& overrides);

} // namespace dss
