#pragma once
/// Two results of the same cells: which became faster, which slower, beyond what the measurement can tell apart.
#include "experiments/runner/records.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// The comparison of one cell.
struct Comparison {
  std::string cell, verdict,
      how; ///< "faster", "slower", "same within resolution", "too few repetitions", "no claim: wrong", "only in OLD", ...
  std::optional<double> old_step_s, new_step_s; ///< medians, seconds a step
  std::optional<double> ratio, low, high; ///< new / old, below 1: faster; bounds from the two medians' 95 % intervals
  bool is_new_wrong = false;              ///< NEW failed its check or did not end
};

/// Resolution where no A/A pair was measured: a ratio nearer to 1 than this is no difference.
constexpr double default_resolution = 0.02;

/// Compares cell by cell. A cell that failed its check, has none, whose status is not "ok", or that has more workers than
/// cores on either side gets no verdict. Samples of nine and more: Mann-Whitney's test (p < 0.05) and a ratio beyond the resolution;
/// six to eight: intervals that do not overlap and a ratio beyond the resolution; fewer: no verdict. Else they are the same
/// within the resolution, or as far from 1 as the interval of the ratio reaches.
std::vector<Comparison> compare_records(const std::vector<Record>& old_records, const std::vector<Record>& new_records,
                                        double resolution);

} // namespace dss
