#pragma once
/// Columns that every table of cells has.
#include "experiments/measure/study_samples.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// These functions fill columns of `row`: what the cell is; its times and its check. @param sample
/// all repetitions of the cell
void put_identity(const CellStudy& study, const Cell& cell, const CellSample& sample, Record& row);
void put_times(const CellStudy& study, const Cell& cell, const CellSample& sample, Record& row);

/// Columns of a run's result in tables, and their values over all repetitions of a cell.
std::vector<std::string> run_columns();
void put_run_fields(const CellSample& sample, Record& row);

/// Resolution of a set of records: the largest distance from 1 of the interval of an A/A pair's
/// ratio. With too few repetitions for an interval, the smallest and largest ratio take its place.
/// Empty without an A/A pair.
std::optional<double> resolution_of(const std::vector<Record>& records);

/// True if no row of a table of cells has a status of failure. Skipped rows do not count as
/// failures.
bool is_without_failures(const Table& table);

} // namespace dss
