#pragma once
/// A study of statics: finds the equilibrium of scenes with every solver and compares it with
/// Newton's. experiments/README.md describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "solver/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A scene at full loads, and at small loads for which linear equations are accurate enough.
struct StaticsCase {
  std::string scene;
  std::vector<Override> set;
  double small_loads = 1e-6;
  bool settles = false; ///< also use relaxation with the scene's masses, and a damped run in time
};

/// All cases of the study.
struct StaticsStudy {
  std::string name, title;
  std::string variant = "auto"; ///< variant for explicit steps
  /// Largest difference of displacements from Newton's, relative to the largest displacement.
  double bar = 1e-8;
  std::vector<StaticsCase> cases; ///< cases that the scale keeps
};

/// Reads the key "statics". @throws InputError with the file, the JSON pointer and the mistake
StaticsStudy read_statics(const StudyFile& file);

/// One row for each case, load and solver. `status` is "passed", "failed", or "linear" if linear
/// equations are not expected to be accurate.
Table statics_table(const StaticsStudy& study);
/// The table as text.
std::string statics_text(const StaticsStudy& study, const Table& table);

} // namespace dss
