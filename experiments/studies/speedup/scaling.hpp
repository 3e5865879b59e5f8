#pragma once
/// How speed changes with the number of ranks: strong scaling (the same problem on more ranks) and
/// weak scaling (a problem that grows with them).
#include "experiments/measure/study_samples.hpp"

#include <string>
#include <vector>

namespace dss {

/// Karp and Flatt's serial fraction (1/S - 1/R) / (1 - 1/R), measured from a speed-up S on R > 1
/// ranks: what grows with R is overhead, what does not is serial. Negative for S > R.
double karp_flatt(double speedup, int ranks);

const std::vector<std::string>& scaling_columns();
/// Fills scaling_columns() of a cell on several ranks; empty for what is not comparable (see
/// StudySamples::speedup).
void put_scaling(const CellStudy& study, const StudySamples& samples, const Cell& cell,
                 Record& row);

} // namespace dss
