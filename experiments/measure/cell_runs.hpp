#pragma once
/// Measures cells. Each repetition is a process of its own, repetitions of different cells are
/// interleaved, and each is recorded at once.
#include "experiments/base/progress.hpp"
#include "experiments/base/records.hpp"
#include "experiments/measure/cell_checks.hpp"
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/study_paths.hpp"

#include <string>
#include <vector>

namespace dss {

/// Runs all repetitions that are not recorded yet. If a cell fails, its reason is recorded and the
/// other cells continue.
/// @param program  path of the program to run for each repetition: this program itself, except in
/// tests
/// @param rounds  stop after so many rounds; 0: measure all
/// @return all records of the file, including those of other scales
/// @throws InputError if nothing can be recorded
std::vector<Record> run_cells(const CellStudy& study, const StudyPaths& paths, bool resume,
                              const std::string& program, CellChecks& checks, long rounds,
                              Progress& progress);

} // namespace dss
