#pragma once
/// Whether lattices of links converge to the continuum that their constants come from: figures of scenes at several refinements against
/// theory, with the observed order (experiments/README.md describes the JSON). Nothing is stepped in time: the
/// equations of solver/statics are solved.
#include "experiments/runner/atlas/formula.hpp"
#include "experiments/runner/records.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// One quantity of one scene, refined. Formulas are over the scene's parameters.
struct ContinuumCheck {
  std::string name, scene, source;
  std::vector<Override> set; ///< of the scene, at every refinement
  std::string refined;       ///< the parameter
  std::vector<double> values;
  Formula spacing; ///< of the lattice [m]
  /// deflection: a field of an element at rest under the loads. frequencies: the smallest ones [rad/s]. critical_load: the value of a parameter at
  /// which the smallest eigenvalue of the loaded scene vanishes.
  std::string quantity;
  std::string field, load_parameter;
  Formula element;
  int count = 1;
  Formula scale;               ///< figures are multiplied by it
  std::vector<Formula> theory; ///< one a figure; none: Timoshenko's cantilever
  Formula bending, shear, mass, rotary, length;
  double bar = 0;                     ///< largest relative error from the stated refinement on
  double bar_at = 0;                  ///< value of the refined parameter
  double order = 0, order_within = 0; ///< that Richardson's figure of the three finest must show
};

struct ContinuumStudy {
  std::string name, title, path;
  std::vector<ContinuumCheck> checks; ///< of the scale
};

/// Nothing if the study has no key "continuum". @throws InputError: file, JSON pointer, what is wrong
std::optional<ContinuumStudy> load_continuum(const std::string& study, const std::string& scale);

/// A row a figure; `status` is "passed", "failed", or "coarse" before the stated refinement.
Table continuum_table(const ContinuumStudy& study);
std::string continuum_text(const ContinuumStudy& study, const Table& table);

/// Order p and limit f of figures that are f + c h^p at three spacings, the finest last. NaN where no p in 0.1 .. 10 does it.
struct Richardson {
  double order = 0, limit = 0;
};
Richardson richardson(const std::vector<double>& spacing, const std::vector<double>& figure);

} // namespace dss
