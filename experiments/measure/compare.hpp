#pragma once
/// Compares two results of the same cells: finds cells that became faster or slower by more than
/// the resolution.
#include "experiments/base/records.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// The comparison of one cell.
struct Comparison {
  /// verdict: "faster", "slower", "same within ... %", "too few repetitions", "no claim: wrong",
  /// "only in OLD", ...; how: the test used, or a reason
  std::string cell, verdict, how;
  std::optional<double> old_step_s, new_step_s; ///< medians [s per step]
  /// ratio = new / old; below 1 means faster. The bounds come from the 95 % intervals of the two
  /// medians.
  std::optional<double> ratio, low, high;
  bool is_new_wrong = false; ///< the cell in NEW failed its check, has no valid time, or is missing
};

/// Resolution if no A/A pair was measured: ratios closer to 1 than this count as equal.
constexpr double default_resolution = 0.02;

/// Compares two sets of records cell by cell.
/// A cell gets no verdict if, on either side, its check did not pass, its status is not "ok", or it
/// has more workers than cores.
/// With at least 9 samples on both sides, a difference needs p < 0.05 in Mann-Whitney's test and a
/// ratio beyond the resolution.
/// With 6 to 8 samples, it needs separate 95 % intervals and a ratio beyond the resolution.
/// With fewer samples there is no verdict.
/// Otherwise the cells are the same, within the resolution or within the interval of the ratio,
/// whichever is wider.
/// @param resolution  smallest relative difference that counts, such as 0.02
std::vector<Comparison> compare_records(const std::vector<Record>& old_records,
                                        const std::vector<Record>& new_records, double resolution);

} // namespace dss
