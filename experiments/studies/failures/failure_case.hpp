#pragma once
/// The failure atlas as data: scenes on which methods should succeed or fail, and why.
/// experiments/README.md describes the JSON.
#include "experiments/measure/formula.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/studies/failures/closed_forms.hpp"
#include "kernels/model.hpp"
#include "solver/model/rotation.hpp"
#include "solver/numerics/method.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// Verdicts of a cell.
inline constexpr const char* atlas_verdicts[] = {"ok", "inaccurate", "drifts", "unstable",
                                                 "refused"};

/// Reference of a figure: a closed form, or a converged state of the oracle.
struct AtlasReference {
  const ClosedForm* form = nullptr;
  std::map<std::string, Formula> arguments; ///< of the closed form
  /// Without a closed form: the oracle's step is halved until the state changes by less than this.
  double converged = 0;
  /// Scene for the oracle if it is not the case's own. The motion of element `base` is subtracted
  /// from its state.
  std::string scene;
  std::size_t base = 0;
};

/// The verdict that theory predicts for some cells of a case. Empty lists match all cells.
struct Expectation {
  std::vector<std::string> methods, precisions, rotations;
  std::vector<Override> set; ///< matches cells with these overrides
  std::string verdict, why;
  Formula predicted; ///< predicted figure
  double within = 0; ///< allowed relative deviation from the prediction
};

/// One scene with one question. Every combination of set, step, method, precision and rotation is a
/// cell.
struct FailureCase {
  std::string name, scene, variant = "auto", metric;
  std::vector<std::vector<Override>> sets;
  std::vector<Formula> dt;
  Formula steps, end;  ///< one of the two: number of steps, or end time [s]
  Formula omega, rate; ///< of a mode of the scene, for `mode_limit`; may be absent
  /// A formula of the case uses `limit`, which takes long to compute for large scenes.
  bool names_limit = false;
  bool is_forced = false;
  std::vector<std::string> methods, precisions, rotations;
  std::string model;
  Field field = ux; ///< for the metric `value`: field of an element, divided by a scale
  Formula element, scale;
  AtlasReference reference;
  /// Bounds of the figure: ok_below and unstable_above for its magnitude, ok_at_least for the
  /// figure itself.
  Formula ok_below, ok_at_least, unstable_above;
  std::string otherwise; ///< verdict if the figure is outside the bounds: inaccurate or drifts
  std::vector<Expectation> expectations; ///< if several match a cell, the last one counts
};

/// All cases of the atlas.
struct FailureStudy {
  std::string name, title, path;
  std::vector<FailureCase> cases; ///< cases that the scale keeps
};

/// Reads the key "failures". @throws InputError with the file, the JSON pointer and the mistake
FailureStudy read_failures(const StudyFile& file);

/// Names of the metrics; atlas_run.hpp defines them.
const std::vector<std::string>& atlas_metrics();
/// True if the metric compares with a reference state.
bool needs_reference(const std::string& metric);

} // namespace dss
