#pragma once
/// Speed-up tables: times of cells, ratios to bases, and the published figures beside them.
#include "experiments/measure/cell_study.hpp"
#include "experiments/measure/study_file.hpp"

#include <string>
#include <vector>

namespace dss {

/// A published figure, beside the measured ones and never in their columns.
struct PaperRow {
  std::string label;
  double wall_s = 0, speedup = 0; ///< speedup 0: none is published
  std::string set{}; ///< overrides of the problem as a cell's text, "n=50"; may be empty
};

struct SpeedupStudy : CellStudy {
  std::string paper_source;
  std::vector<PaperRow> paper;
};

/// Every scene is loaded with its overrides, so that a study with a wrong one is refused before it
/// measures.
/// @throws InputError: file, JSON pointer, what is wrong and what would be right
SpeedupStudy read_speedup(const StudyFile& file, int cores);

} // namespace dss
