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
