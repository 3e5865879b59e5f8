#pragma once
/// Checks that lattices of links converge to the continuum of their constants. Figures of scenes
/// are computed at several refinements and compared with theory, and the order of convergence is
/// observed. The equations of solver/statics are solved; nothing is stepped in time.
/// experiments/README.md describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/formula.hpp"
#include "experiments/measure/richardson.hpp"
#include "experiments/measure/study_file.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// One quantity of one scene at several refinements. Formulas are over the scene's parameters.
struct ContinuumCheck {
  std::string name, scene, source;
  std::vector<Override> set; ///< overrides of the scene at every refinement
  std::string refined;       ///< the refined parameter
  std::vector<double> values;
  Formula spacing; ///< spacing of the lattice [m]
  /// One of:
  /// - deflection: a field of an element in equilibrium under the loads
  /// - frequencies: the smallest natural frequencies [rad/s]
  /// - critical_load: the value of a parameter at which the smallest eigenvalue of the loaded scene
  /// vanishes
  std::string quantity;
  Field field = ux;
  std::string load_parameter;
  Formula element;
  int count = 1;
  Formula scale;               ///< figures are multiplied by it
  std::vector<Formula> theory; ///< one per figure; empty: Timoshenko's cantilever
  Formula bending, shear, mass, rotary, length;
  double bar = 0;    ///< largest relative error from the refinement `bar_at` on
  double bar_at = 0; ///< value of the refined parameter
  /// Declared order, and the allowed difference of the order that Richardson's extrapolation of the
  /// three finest shows.
  double order = 0, order_within = 0;
};

/// All checks of the study.
struct ContinuumStudy {
  std::string name, title, path;
  std::vector<ContinuumCheck> checks; ///< with the refinements that the scale keeps
};

/// Reads the key "continuum". @throws InputError with the file, the JSON pointer and the mistake
ContinuumStudy read_continuum(const StudyFile& file);

/// One row for each figure. `status` is "passed", "failed", or "coarse" for refinements below
/// `bar_at`.
Table continuum_table(const ContinuumStudy& study);
/// The table as text.
std::string continuum_text(const ContinuumStudy& study, const Table& table);

} // namespace dss
