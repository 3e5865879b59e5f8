#pragma once
/// The study of step limits (experiments/README.md describes the JSON): predicted and measured for every explicit method,
/// over damping ratios of one mode and on scenes; and the energy that methods take from an undamped mode.
#include "experiments/runner/records.hpp"
#include "solver/scene/scene.hpp"
#include "variants/api.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

struct StabilityStudy {
  /// A problem whose limits are looked for.
  struct Case {
    std::string name, set; ///< as the study names it; overrides in words
    Scene scene;
    std::optional<double> zeta; ///< damping ratio, of a problem of one mode
  };
  std::string name, title;
  const Plugin* plugin = nullptr;
  std::vector<Case> cases;
  std::optional<Case> undamped; ///< one mode, whose energy is looked at
  double element_steps = 0;     ///< budget of each run
  int energy_points = 0;        ///< h omega of each method
  int map_points = 0;           ///< h omega and zeta in the map of |R|
};

/// Nothing if the study has no key "stability". @throws InputError: file, JSON pointer, what is wrong
std::optional<StabilityStudy> load_stability(const std::string& study, const std::string& scale);

/// Limits: a row for each case and explicit method. The status is that of LimitComparison.
Table stability_table(const StabilityStudy& study);
/// Energy: a row for each method and h omega.
Table stability_energy_table(const StabilityStudy& study);
/// Theory alone: the spectral radius of one step of each method over h omega and zeta, for the picture.
Table stability_map_table(const StabilityStudy& study);

/// The limits, for people.
std::string stability_text(const StabilityStudy& study, const Table& limits, const Table& energy);

} // namespace dss
