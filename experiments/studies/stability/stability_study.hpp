#pragma once
/// The study of step limits: predicted and measured limits of every explicit method, over damping
/// ratios of one mode and on scenes. Also the energy that methods add to or remove from an undamped
/// mode. experiments/README.md describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "solver/scene/scene.hpp"
#include "variants/api/api.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// The problems of the study and how finely they are measured.
struct StabilityStudy {
  /// A problem whose limits are measured.
  struct Case {
    std::string name, set; ///< name in the study; overrides as text
    Scene scene;
    std::optional<double> zeta; ///< damping ratio, for a problem of one mode
  };
  std::string name, title;
  const Plugin* plugin = nullptr;
  std::vector<Case> cases;
  std::optional<Case> undamped; ///< one undamped mode, for the energy
  double element_steps = 0;     ///< budget of each run
  int energy_points = 0;        ///< values of h omega for each method
  int map_points = 0;           ///< values of h omega and of zeta in the map of |R|
};

/// Reads the key "stability". @throws InputError with the file, the JSON pointer and the mistake
StabilityStudy read_stability(const StudyFile& file);

/// Limits: one row for each case and explicit method. The status is that of LimitComparison.
Table stability_table(const StabilityStudy& study);
/// Energy: one row for each method and h omega.
Table stability_energy_table(const StabilityStudy& study);
/// Theory only: the spectral radius of one step of each method over h omega and zeta, for the
/// figure.
Table stability_map_table(const StabilityStudy& study);

/// The limits as text.
std::string stability_text(const StabilityStudy& study, const Table& limits, const Table& energy);

} // namespace dss
