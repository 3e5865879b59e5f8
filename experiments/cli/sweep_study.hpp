#pragma once
/// A study of all combinations of some choices, without a file of the user's (`dssbench sweep`).
#include "experiments/base/progress.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/study_file.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace dss {

/// Every combination of these is a cell. Empty lists: the default of studies.
struct SweepRequest {
  std::string scene, name;      ///< name: of the study; empty: sweep_SCENE
  std::vector<std::string> set; ///< "n=40,80": a key and its values
  std::vector<std::string> variants, models, precisions, integrators, halos, decompositions;
  std::vector<std::string> threads{"1"}, ranks{"1"};
  std::vector<std::string> members; ///< numbers of equal members of ensembles
  std::string device;               ///< of the variants that compute on devices
  std::string base;                 ///< of the speed-ups; empty: the first variant
  long steps = 0;                   ///< of all cells; 0: as many as a sample needs
  double sample_s = 0.1;            ///< least time of a sample [s]
  long repetitions = 6;             ///< of a cell, at least
  double budget_s = 120;            ///< no repetitions beyond the least number after this time [s]
};

/// Name of the only scale of such a study.
inline constexpr const char* sweep_scale = "sweep";

/// Name of the study: that of the request, or else of its scene.
/// @throws InputError if it cannot name files
std::string sweep_name(const SweepRequest& request);

/// Key and values of "n=40,80". A comma inside brackets does not separate.
/// @throws InputError if there is no key or an empty value
std::pair<std::string, std::vector<std::string>> values_of_set(const std::string& text);

/// Speed of a cell in a trial.
struct CellRate {
  std::string set, variant; ///< set: overrides as text
  double steps_per_s = 0;
};

/// The study as JSON (experiments/studies/speedup/README.md).
/// @param rates  of a trial; empty: all cells have the steps of the request, at least two
/// @throws InputError for choices that no study can have
nlohmann::ordered_json sweep_study(const SweepRequest& request, const std::vector<CellRate>& rates);

/// The study of sweep_study as if it were in a file.
StudyFile sweep_file(const nlohmann::ordered_json& study);

/// Runs every cell for a moment, one after the other. Cells that do not run are left out; the study
/// shows them as failed.
/// @throws InputError with the first reason if no cell runs
std::vector<CellRate> trial_rates(const CellStudy& study, Progress& progress);

} // namespace dss
