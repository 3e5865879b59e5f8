#pragma once
/// Scenes: JSON files that say what to compute. README.md and scene.schema.json beside this file
/// describe the format.
#include "solver/model/problem.hpp"
#include "solver/scene/geometry.hpp"
#include "solver/scene/scene_text.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

namespace dss {

/// A small version of a scene. `verify` compares every variant with the oracle on it.
struct VerifyCase {
  nlohmann::json set; ///< overrides by key
  long steps = 0;
};

/// A scene: its problem, its parameters and its defaults for a run.
struct Scene {
  std::string name, title, path;
  Problem problem;
  std::map<std::string, double> parameters;
  std::vector<VerifyCase> verify; ///< at least one
  std::string asked_model;        ///< as in the scene, or "auto"
  std::string model;              ///< for studies: asked_model, but `spatial` instead of `auto`
  std::string integrator;         ///< default method: a name of find_method
  std::string analysis;           ///< default analysis: "dynamic", "static" or "modal"
};

/// A scene as `dssbench list scenes` shows it.
struct SceneListing {
  std::string name, title, path;
  std::map<std::string, double> parameters; ///< default values
};

/// Reads a scene by name (see scene_directory) or path. Applies the overrides in order.
/// @throws InputError for any fault, one line "file: /json/pointer: what is wrong and what would be
///     right"
Scene load_scene(const std::string& name_or_path, const std::vector<Override>& overrides = {});

/// Finds bounds of the number of elements without building the scene, which takes seconds if it is
/// large.
/// @throws InputError as load_scene, for what it reads
ShapeSize scene_size(const std::string& name_or_path, const std::vector<Override>& overrides = {});

/// Reads only the analysis of a scene.
/// @throws InputError for a file that cannot be read
std::string scene_analysis(const std::string& name_or_path,
                           const std::vector<Override>& overrides = {});

/// All shipped scenes, sorted by name.
std::vector<SceneListing> list_scenes();

/// Overrides for load_scene that turn a scene into its small version.
std::vector<Override> verify_overrides(const VerifyCase& verify);

} // namespace dss
