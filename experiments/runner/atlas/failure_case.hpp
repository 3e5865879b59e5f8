#pragma once
/// A failure atlas as data: scenes on which methods are expected to succeed or to fail, and why (experiments/README.md describes the JSON).
#include "experiments/runner/atlas/closed_forms.hpp"
#include "experiments/runner/atlas/formula.hpp"
#include "solver/model/model.hpp"
#include "solver/model/rotation.hpp"
#include "solver/numerics/method.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// What a cell of the atlas says.
inline constexpr const char* atlas_verdicts[] = {"ok", "inaccurate", "drifts", "unstable", "refused"};

/// What figures are compared with.
struct AtlasReference {
  const ClosedForm* form = nullptr;
  std::map<std::string, Formula> arguments; ///< of the closed form
  double converged = 0; ///< else the oracle in long double, its step halved until the state changes by less than this
  std::string scene;    ///< of the oracle, other than the case's own: its state less the motion of element `base`
  std::size_t base = 0;
};

/// The verdict that theory predicts for some cells of a case. Empty lists: all.
struct Expectation {
  std::vector<std::string> methods, precisions, rotations;
  std::vector<Override> set; ///< cells that have these overrides
  std::string verdict, why;
  Formula predicted; ///< the figure
  double within = 0; ///< relative deviation of the figure from it that is allowed
};

/// One scene with one question. Every combination of set, step, method, precision and rotation is a cell.
struct FailureCase {
  std::string name, scene, variant = "auto", metric;
  std::vector<std::vector<Override>> sets;
  std::vector<Formula> dt;
  Formula steps, end;       ///< one of them: number of steps, or the time to reach [s]
  Formula omega, rate;      ///< of a mode of the scene, for `mode_limit`; may be absent
  bool names_limit = false; ///< a formula of the case names `limit`, which takes long to find on large scenes
  bool is_forced = false;
  std::vector<std::string> methods, precisions, rotations;
  std::string model;
  std::string field; ///< of the metric `value`: field of an element over a scale
  Formula element, scale;
  AtlasReference reference;
  Formula ok_below, ok_at_least,
      unstable_above;                    ///< of the figure's magnitude, of the figure, of the figure's magnitude
  std::string otherwise;                 ///< verdict of a figure outside: inaccurate or drifts
  std::vector<Expectation> expectations; ///< the last that fits a cell counts
};

struct FailureStudy {
  std::string name, title, path;
  std::vector<FailureCase> cases; ///< of the scale
};

/// Nothing if the study has no key "failures". @throws InputError: file, JSON pointer, what is wrong
std::optional<FailureStudy> load_failures(const std::string& study, const std::string& scale);

/// What can be asked of a run; atlas_run.hpp says what each is.
const std::vector<std::string>& atlas_metrics();
bool needs_reference(const std::string& metric);
/// Names of an element's fields, in their order.
const std::vector<std::string>& field_names();

} // namespace dss
