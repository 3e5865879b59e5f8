#pragma once
/// Reads the cells of a study, its scale, bases and twins from JSON.
#include "experiments/measure/cell_block.hpp"
#include "experiments/measure/study_file.hpp"

namespace dss {

/// Reads "cells", "base", "twin" and the scale. "base" and the scale's "steps" are required unless
/// `rules.expand` is set.
/// @throws InputError with the file, the JSON pointer, the mistake and a correct example
void read_cells(const StudyFile& file, const CellRules& rules, CellStudy& study);

} // namespace dss
