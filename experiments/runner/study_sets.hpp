#pragma once
/// What studies say of scenes: overrides, and files beside the study.
#include "experiments/runner/study_reader.hpp"
#include "solver/model/model.hpp"
#include "solver/scene/scene.hpp"

#include <string>
#include <vector>

namespace dss {

/// Alternative overrides of a scene.
using Sets = std::vector<std::vector<Override>>;

/// An object of overrides, each of one value or several: every combination of them.
/// {"n": [4, 8], "E": 1e7} -> {n=4, E=1e7}, {n=8, E=1e7}. @throws InputError with the place
Sets combinations(const JsonPlace& overrides);
/// Of an object's member, which may be absent: no overrides.
Sets combinations(const JsonPlace& object, const std::string& key);
/// Where each key has one value. @throws InputError with the place
std::vector<Override> one_set(const JsonPlace& overrides);

/// A model, a precision. @throws InputError with the place and the nearest that is one
Model model_in(const JsonPlace& place);
Precision precision_in(const JsonPlace& place);

/// File of a scene that a study names: beside the study if it ends in .json, else a shipped one's name.
std::string scene_beside(const std::string& study_path, const std::string& scene);

} // namespace dss
