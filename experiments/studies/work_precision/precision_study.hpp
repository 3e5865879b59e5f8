#pragma once
/// Work against precision: cells with steps of their own, each compared with the solution of its
/// scene.
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/studies/work_precision/precision_rules.hpp"

#include <map>
#include <string>
#include <vector>

namespace dss {

/// What a cell of this kind has besides its step.
struct CellAccuracy {
  SavedTimes times;      ///< at which it is compared with the solution
  double step_limit = 0; ///< largest stable step [s]; 0: unknown before the run
};

/// What a scale changes.
struct PrecisionScale {
  double shorten = 1;        ///< of end times
  double repeat_for = 0.1;   ///< runs shorter than this start again until so much was measured [s]
  std::vector<int> halvings; ///< in place of those of the blocks, if there are any
};

struct PrecisionStudy : CellStudy {
  PrecisionRules rules;
  PrecisionScale precision_scale;
  std::map<std::string, CellAccuracy> accuracy; ///< by Cell::key

  const CellAccuracy& accuracy_of(const Cell& cell) const { return accuracy.at(cell.key()); }
};

/// Every scene is loaded with its overrides. @throws InputError: file, JSON pointer, what is wrong
PrecisionStudy read_precision(const StudyFile& file, int cores);

} // namespace dss
