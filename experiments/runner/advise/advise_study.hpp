#pragma once
/// The study that judges advice (experiments/README.md describes the JSON): its errors by the oracle, its speed by trying everything.
#include "experiments/runner/advise/quantity.hpp"
#include "experiments/runner/precision/saved_times.hpp"
#include "experiments/runner/precision/solution.hpp"
#include "experiments/runner/records.hpp"
#include "solver/scene/scene.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace dss {

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
  double bar = 1.5; ///< times the cheapest that advice may take
  std::vector<Case> cases;
};

/// Nothing if the study has no key "advise". Every scene is loaded. @throws InputError: file, JSON pointer, what is wrong
std::optional<AdviseStudy> load_advise(const std::string& study, const std::string& scale);

/// One row for each scene and tolerance. The status is `failed` where the true error of what was advised is above the tolerance or nothing was advised; the verdict says whether it
/// is within `bar` times the cheapest configuration found.
/// @param oracle  directory of solutions, made where they are not there  @param note  is told what is done
Table advise_table(const AdviseStudy& study, const std::string& oracle,
                   const std::function<void(const std::string&)>& note);

std::string advise_study_text(const AdviseStudy& study, const Table& table);

} // namespace dss
