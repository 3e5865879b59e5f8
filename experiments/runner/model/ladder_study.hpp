#pragma once
/// The model ladder: every model on every scene, its time and its error against the spatial oracle, and what `--model auto` makes of the scene
/// (experiments/README.md describes the JSON).
#include "experiments/runner/records.hpp"
#include "solver/model/model.hpp"
#include "solver/scene/json/document.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace dss {

struct LadderScene {
  std::string scene; ///< name or path
  std::vector<Override> set;
  std::optional<long> steps;
  std::string precision = "f64";
  Model ends_with = Model::spatial; ///< what auto's run must end with
  std::vector<Model> fails;         ///< models whose error must exceed the tolerance
  std::vector<Model> suffices;      ///< and models, proven or not, whose error must not
};

struct LadderStudy {
  std::string name, title, scale, variant;
  double repeat_for = 0; ///< [s]
  std::vector<LadderScene> scenes;
};

/// Nothing if the study has no key "model_ladder". @throws InputError: file, JSON pointer, what is wrong
std::optional<LadderStudy> load_ladder(const std::string& study, const std::string& scale);

/// A row a model and one for auto. `verdict`: sufficient or insufficient, by the error; `provable`: proven, bounded, or no. `status` is "failed" where an
/// expectation is missed, auto's result is outside the tolerance, or a model that is proven is.
Table ladder_table(const LadderStudy& study, const std::function<void(const std::string&)>& note);
std::string ladder_text(const LadderStudy& study, const Table& table);

} // namespace dss
