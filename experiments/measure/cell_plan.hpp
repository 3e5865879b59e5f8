#pragma once
/// Text of `dssbench experiment --dry-run` for studies of cells.
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/study_paths.hpp"

#include <string>

namespace dss {

/// One line for each cell, then the number of repetitions, the time budget and the output files.
std::string plan_text(const CellStudy& study, const StudyPaths& paths);

} // namespace dss
