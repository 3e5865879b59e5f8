#pragma once
/// The model ladder: runs every model on every scene and reports its time and its error against the
/// spatial oracle. Also checks the choice of `--model auto`. experiments/README.md describes the
/// JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "kernels/model.hpp"
#include "solver/scene/scene_text.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A scene and the expected verdicts.
struct LadderScene {
  std::string scene; ///< name or path
  std::vector<Override> set;
  std::optional<long> steps;
  std::string precision = "f64";
  Model ends_with = Model::spatial; ///< model with which a run with --model auto must end
  std::vector<Model> fails;         ///< models whose error must exceed the tolerance
  std::vector<Model> suffices; ///< models whose error must be within the tolerance, proven or not
};

/// All scenes of the study.
struct LadderStudy {
  std::string name, title, scale, variant;
  double repeat_for = 0; ///< shortest total time of a timed run [s]
  std::vector<LadderScene> scenes;
};

/// Reads the key "model_ladder". @throws InputError with the file, the JSON pointer and the mistake
LadderStudy read_ladder(const StudyFile& file);

/// One row for each model and one for auto. `verdict` is sufficient or insufficient, by the error.
/// `provable` is proven, bounded or no. `status` is "failed" if an expectation is not met, or if
/// the result of auto or of a proven model is outside the tolerance.
/// @param note  receives a line of text for each scene
Table ladder_table(const LadderStudy& study, const std::function<void(const std::string&)>& note);
/// The table as text.
std::string ladder_text(const LadderStudy& study, const Table& table);

} // namespace dss
