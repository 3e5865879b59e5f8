#pragma once
/// Translates a cell to a command line of `dssbench run`, and its JSON result to a row of the raw
/// file.
#include "experiments/base/records.hpp"
#include "experiments/measure/cell_study.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// Names the cell, repetition and attempt that a row belongs to.
struct RecordPlace {
  const CellStudy& study;
  const Cell& cell;
  long repetition = 0, attempt = 0;
  int cores = 1; ///< cores that this process may use
};

/// Columns of raw/NAME.csv. The file has one row for each attempt of each repetition.
const std::vector<std::string>& raw_columns();

/// A field of a run's record, in all places where it appears.
struct ColumnMeaning {
  std::string key;      ///< key in the JSON of `dssbench run`; empty: not there
  std::string raw;      ///< column of raw/NAME.csv; empty: not there
  std::string in_table; ///< how repetitions become one value of a table; empty: not there
  std::string unit, meaning;
};
/// All fields of cells and runs, in the order of raw_columns().
std::vector<ColumnMeaning> column_meanings();

/// Columns of a table that say what the cell of a row is.
std::vector<std::string> identity_columns();
void put_identity(const RecordPlace& place, Record& row);

/// Command line of one repetition.
/// @param checks  options that name the reference of the check
std::vector<std::string> run_arguments(const CellStudy& study, const Cell& cell,
                                       const std::vector<std::string>& checks);

/// Row of a repetition that has no time: skipped, failed, or past its time limit.
Record failure_record(const RecordPlace& place, const std::string& status,
                      const std::string& reason);

/// Row made from the output of `dssbench run --json`.
/// @param process_s  wall time of the whole process [s]
Record result_record(const RecordPlace& place, const nlohmann::json& json, double process_s);

} // namespace dss
