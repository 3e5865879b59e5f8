#pragma once
/// Reads overrides of scenes, and finds scene files beside a study.
#include "solver/json/object_node.hpp"
#include "solver/scene/scene.hpp"

#include <string>
#include <vector>

namespace dss {

/// Alternative sets of overrides of a scene.
using Sets = std::vector<std::vector<Override>>;

/// Reads an object of overrides, each with one value or a list. Returns every combination: {"n":
/// [4, 8], "E": 1e7} gives {n=4, E=1e7} and {n=8, E=1e7}.
/// @throws InputError with the place
Sets combinations(const Node& overrides);
/// Reads a member of an object. If it is absent, returns one empty set of overrides.
Sets combinations(ObjectNode& object, const std::string& key);
/// Reads overrides that have one value each. @throws InputError with the place
std::vector<Override> one_set(const Node& overrides);
/// Reads a member of an object. If it is absent, returns no overrides.
std::vector<Override> one_set(ObjectNode& object, const std::string& key);

/// Path of a scene that a study names. A name that ends in .json is a file beside the study, or
/// else in the folder of shipped scenes. Any other name is returned as it is: it is the name of a
/// shipped scene.
std::string scene_beside(const std::string& study_path, const std::string& scene);

} // namespace dss
