#pragma once
/// Derives the table of a study, one row a cell, from its raw records.
#include "experiments/runner/records.hpp"
#include "experiments/runner/study_samples.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// Table of a study. Measured times are in measured_wall_s (median) with an interval; times scaled from fewer steps are
/// in extrapolated_wall_s, published ones in paper_wall_s: no column mixes them. Speed-ups are medians of ratios of
/// interleaved pairs; a cell that failed its check, or has more workers than cores, gets none.
Table derive_table(const Study& study, const std::vector<Record>& records);

/// What a row says of its cell, and of the times and the check of its sample, in the columns of derive_table.
void put_identity(const Study& study, const Cell& cell, const CellSample& sample, Record& row);
void put_times(const Study& study, const Cell& cell, const CellSample& sample, Record& row);

/// Resolution of a set of records: how far the ratio of an A/A pair, or its interval's ends, is from 1; nothing without
/// a pair.
std::optional<double> resolution_of(const std::vector<Record>& records);

/// The table for people.
std::string table_text(const Study& study, const Table& table);

} // namespace dss
