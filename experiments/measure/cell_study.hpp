#pragma once
/// A study of cells: the cells and how they are measured. experiments/README.md describes the JSON.
#include "experiments/measure/cell.hpp"

#include <map>
#include <string>
#include <vector>

namespace dss {

/// How much is measured. Typical scales take seconds, minutes, or use the paper's problem sizes.
struct Scale {
  std::string name;
  long steps = 0;
  long oracle_steps = 0; ///< the oracle checks the state after min(steps, oracle_steps) steps
  long warmup_steps = 2;
  double warmup_s = 0.15; ///< least time of the warm-up of several workers [s]
  /// Number of steps that the `extrapolated_...` columns are scaled to; 0: that of each cell.
  long full_steps = 0;
  /// Steps of the cells with a given override text, such as "n=50"; they replace `steps`.
  std::map<std::string, long> steps_by_set;
  /// Upper limits of the steps of slow variants. A key is "scalar", or "scalar n=50" for one set of
  /// overrides.
  std::map<std::string, long> steps_for;
  /// Slow variants that are also run once with `full_steps`, to check that their times scale with
  /// the steps.
  std::vector<std::string> whole_once;
  /// Number of repetitions whose final states the oracle checks; the others must have the same
  /// bits. 0: all.
  long tail_checks = 0;
  long min_repetitions = 6, max_repetitions = 30;
  long samples = 1;        ///< of a repetition; the fastest counts
  long retries = 3;        ///< largest number of times that a contaminated repetition is repeated
  double patience_s = 120; ///< for waiting for a quiet machine and for these repetitions [s]
  /// a cell has converged at this relative half-width of its 95 % interval
  double half_width = 0.02;
  double budget_s = 240;     ///< no repetitions beyond the least number after this time [s]
  double time_limit_s = 120; ///< for one repetition [s]
};

/// A study whose figures are times of cells.
struct CellStudy {
  std::string name, title, path;
  std::vector<std::string> bases; ///< variants that speed-ups refer to, on 1 rank and 1 thread
  std::vector<Cell> cells;
  Scale scale;
};

} // namespace dss
