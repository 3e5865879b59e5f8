#pragma once
/// Scenes: JSON files that say what to compute. The format is in README.md and scene.schema.json beside this file.
#include "solver/model/problem.hpp"
#include "solver/scene/json/document.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

namespace dss {

/// A small version of a scene, on which `verify` compares every variant with the oracle.
struct VerifyCase {
  nlohmann::json set; ///< overrides by key
  long steps = 0;
};

struct Scene {
  std::string name, title, path;
  Problem problem;
  std::map<std::string, double> parameters;
  std::vector<VerifyCase> verify; ///< at least one
  std::string asked_model;        ///< as the scene says, or "auto"
  std::string model;              ///< of studies: the same, but spatial where it is auto
  std::string integrator;         ///< default: a name of find_method
  std::string analysis;           ///< default: "dynamic", "static" or "modal"
};

struct SceneListing {
  std::string name, title, path;
  std::map<std::string, double> parameters; ///< defaults
};

/// Reads a scene by name (see scene_directory) or path, with overrides applied in order.
/// @throws InputError, one line "file: /json/pointer: what is wrong and what would be right", for any fault
Scene load_scene(const std::string& name_or_path, const std::vector<Override>& overrides = {});

/// The analysis that a scene asks for, before anything else of it is read. @throws InputError for a file that cannot be read
std::string scene_analysis(const std::string& name_or_path, const std::vector<Override>& overrides = {});

/// Every shipped scene, by name.
std::vector<SceneListing> list_scenes();

/// Overrides that turn a scene into its small version, for load_scene.
std::vector<Override> verify_overrides(const VerifyCase& verify);

} // namespace dss
