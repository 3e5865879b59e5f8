#pragma once
/// The input of an error budget: its scenes and their sources of error. experiments/README.md
/// describes the JSON.
#include "experiments/measure/study_file.hpp"
#include "experiments/run/state/saved_times.hpp"
#include "experiments/run/state/solution.hpp"
#include "solver/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// One scene with the step, method and grid of its usual runs.
struct BudgetScene {
  std::string label, scene, variant, integrator;
  std::vector<Override> set;
  SavedTimes times;
  double dt = 0; ///< [s]
  /// Overrides of three successively finer grids, of which the first is the scene's own; may be
  /// empty.
  std::vector<std::vector<Override>> refinement;
  /// ratio of the elements' edges from one grid to the next; steps shrink likewise
  double ratio = 2;
  /// all grids are the same body; if not, there is no limit to extrapolate to
  bool is_one_body = true;
  std::string refined; ///< text: the properties that refinement keeps
  std::vector<std::string> precisions, models, rotations;
};

/// All scenes of the study.
struct ErrorBudgetStudy {
  std::string name, title, scale;
  SolutionRule solution;
  std::vector<BudgetScene> scenes;
};

/// Reads the key "error_budget" and loads every scene.
/// @throws InputError with the file, the JSON pointer and the mistake
ErrorBudgetStudy read_error_budget(const StudyFile& file);

} // namespace dss
