#pragma once
/// Derives the table of a study, one row a cell, from its raw records.
#include "experiments/base/records.hpp"
#include "experiments/studies/speedup/speedup_study.hpp"

#include <string>
#include <vector>

namespace dss {

/// Table of a study. Measured times are in measured_wall_s (median) with an interval; times scaled
/// from fewer steps are in extrapolated_wall_s, published ones in paper_wall_s: no column mixes
/// them. Speed-ups are medians of ratios of interleaved pairs; a cell that failed its check, or has
/// more workers than cores, gets none.
Table derive_table(const SpeedupStudy& study, const std::vector<Record>& records);

/// The table for people.
std::string table_text(const SpeedupStudy& study, const Table& table);

} // namespace dss
