#pragma once
/// Finds the cells that another cell is compared with.
#include "experiments/measure/cell_study.hpp"

#include <string>

namespace dss {

/// Finds the cell on 1 rank with this variant, number of threads and overrides.
/// Its scene, model, precision and method are those of `like`.
/// If `variant` is the variant of `like`, its device and hybrid members are also those of `like`.
/// @return null if the study has no such cell
const Cell* one_rank_cell(const CellStudy& study, const Cell& like, const std::string& variant,
                          int threads, const std::string& set_text);

/// Base of strong scaling: the same problem, variant and threads on 1 rank; null if there is none.
const Cell* strong_base(const CellStudy& study, const Cell& cell);

/// Base of weak scaling: the cell on 1 rank whose problem was enlarged to that of `cell`; null if
/// there is none.
const Cell* weak_base(const CellStudy& study, const Cell& cell);

/// One process with as many threads as `cell` has workers (ranks x threads). It uses the same cores
/// without messages. Null if there is none.
const Cell* threaded_base(const CellStudy& study, const Cell& cell);

/// True if any cell on several ranks is compared with this one.
bool is_scaling_base(const CellStudy& study, const Cell& cell);

/// True if other cells are compared with this one. Such a cell is measured as long as any cell is.
bool is_partner(const CellStudy& study, const Cell& cell);

} // namespace dss
