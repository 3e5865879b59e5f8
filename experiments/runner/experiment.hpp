#pragma once
/// Measures a study: every repetition of a cell in a process of its own, interleaved, recorded as measured.
#include "experiments/runner/study.hpp"

#include <string>

namespace dss {

struct ExperimentPaths {
  std::string raw, context, table, oracle_directory;
};

/// results/raw/NAME.csv and .json, results/tables/NAME.csv, results/oracle/ under a directory.
ExperimentPaths experiment_paths(const std::string& directory, const std::string& name);

/// Runs what of a study is not yet recorded and writes its table. Cells that fail are recorded with their reason and
/// the rest goes on.
/// @param program  what is run for each repetition; this very program, except in tests
/// @return true if no cell failed or was wrong (skipped ones count as neither)
/// @throws InputError if nothing can be recorded
bool run_experiment(const Study& study, const std::string& directory, bool resume, const std::string& program);

} // namespace dss
