#pragma once
/// The study that judges advice: its errors against the oracle, and its speed against a full
/// search. experiments/README.md describes the JSON.
#include "experiments/base/records.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/run/advise/quantity.hpp"
#include "experiments/run/state/saved_times.hpp"
#include "experiments/run/state/solution.hpp"
#include "solver/scene/scene.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// Scenes and tolerances for which advice is judged.
struct AdviseStudy {
  struct Case {
    std::string scene;
    std::vector<Override> set;
    Scene loaded;
    SavedTimes times;
    Quantity quantity = Quantity::displacement;
  };
  std::string name, title, scale;
  SolutionRule solution;
  std::vector<double> tolerances;
  double bar = 1.5; ///< allowed time, relative to the cheapest configuration
  std::vector<Case> cases;
};

/// Reads the key "advise" and loads every scene. @throws InputError with the file, the JSON pointer
/// and the mistake
AdviseStudy read_advise(const StudyFile& file);

/// One row for each scene and tolerance. The status is `failed` if nothing was advised, or if the
/// true error of the advised run is above the tolerance. The verdict compares its time with `bar`
/// times that of the cheapest configuration found.
/// @param oracle  directory of solutions; missing ones are computed
/// @param note  receives a line of text for each task
Table advise_table(const AdviseStudy& study, const std::string& oracle,
                   const std::function<void(const std::string&)>& note);

/// The table as text.
std::string advise_study_text(const AdviseStudy& study, const Table& table);

} // namespace dss
