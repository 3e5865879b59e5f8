#pragma once
/// A cell as `dssbench run` takes it, and what that says as a row of the raw file.
#include "experiments/runner/records.hpp"
#include "experiments/runner/study.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dss {

/// Which repetition of which cell a row is of.
struct RecordPlace {
  const Study& study;
  const Cell& cell;
  long repetition = 0, attempt = 0;
  int cores = 1; ///< that this process may use
};

/// Command line of one repetition. @param oracle_file  expected state
std::vector<std::string> run_arguments(const Study& study, const Cell& cell, const std::string& oracle_file,
                                       long repetition = 0);

/// A row for a repetition without a time: skipped, failed, past its time limit.
Record failure_record(const RecordPlace& place, const std::string& status, const std::string& reason);

/// A row of what `dssbench run --json` said, by the columns' names. @param process_s  life of the process [s]
Record result_record(const RecordPlace& place, const nlohmann::json& json, double process_s);

} // namespace dss
