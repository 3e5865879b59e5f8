#pragma once
/// Which errors of which scenes an error budget puts side by side (experiments/README.md describes the JSON).
#include "experiments/runner/precision/saved_times.hpp"
#include "experiments/runner/precision/solution.hpp"
#include "solver/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// One scene at the step, integrator and grid that its user takes.
struct BudgetScene {
  std::string label, scene, variant, integrator;
  std::vector<Override> set;
  SavedTimes times;
  double dt = 0; ///< [s]
  std::vector<std::vector<Override>>
      refinement;          ///< overrides of finer and finer grids, the first the scene's own; may be empty
  double ratio = 2;        ///< of the elements' edges from one grid to the next; the steps follow
  bool is_one_body = true; ///< on all grids; else there is no limit to extrapolate to
  std::string refined;     ///< what refinement keeps, for people
  std::vector<std::string> precisions, models, rotations;
};

struct ErrorBudgetStudy {
  std::string name, title, scale;
  SolutionRule solution;
  std::vector<BudgetScene> scenes;
};

/// Nothing if the study has no key "error_budget". Every scene is loaded. @throws InputError: file, JSON pointer, what is wrong
std::optional<ErrorBudgetStudy> load_error_budget(const std::string& study, const std::string& scale);

} // namespace dss
