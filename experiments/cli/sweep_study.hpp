#pragma once
/// A study of all combinations of some choices, without a file of the user's (`dssbench sweep`).
#include "experiments/measure/cell_study.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// Every combination of these is a cell. Empty lists: the default of studies.
struct SweepRequest {
  std::string scene, name;      ///< name: of the study; empty: from that of the scene
  std::vector<std::string> set; ///< "n=40,80": a key and its values
  std::vector<std::string> variants, models, precisions, integrators, halos, decompositions;
  std::vector<std::string> threads{"1"}, ranks{"1"};
  std::string base;      ///< of the speed-ups; empty: the first variant
  long steps = 0;        ///< of all cells; 0: as many as a sample needs
  double sample_s = 0.1; ///< least time of a sample [s]
  long repetitions = 6;  ///< of a cell, at least
  double budget_s = 120; ///< no repetitions beyond the least number after this time [s]
};

/// Name of the scale of a study that a sweep makes.
inline constexpr const char* sweep_scale = "sweep";

/// Name of a sweep's study, as its files have it.
std::string sweep_name(const SweepRequest& request);

/// Values of "n=40,80". A comma inside brackets does not separate.
/// @throws InputError if there is no key or an empty value
std::pair<std::string, std::vector<std::string>> values_of_set(const std::string& text);

/// Steps of the fastest cell of each variant, by overrides as text, then by variant.
using SweepSteps = std::map<std::string, std::map<std::string, long>>;

/// The study as JSON (experiments/studies/speedup/README.md).
/// @param steps  empty: all cells have those of the request, or two
nlohmann::ordered_json sweep_study(const SweepRequest& request, const SweepSteps& steps);

/// Runs every cell once, for a moment, to find how many steps a sample takes.
/// @param study  of sweep_study, without steps
/// @throws InputError with the reason of the first cell that does not run
SweepSteps trial_steps(const CellStudy& study, double sample_s);

} // namespace dss
