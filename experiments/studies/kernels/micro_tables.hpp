#pragma once
/// tables/kernels.csv: each microbenchmark with its interval and its place under the roofline.
#include "experiments/measure/ceilings/ceilings.hpp"

namespace dss {

/// One row a cell. The roof is the smaller of the peak of the variant's instruction set and the
/// level's best bandwidth times the intensity; `limiter` is which. A wrong cell keeps its time and
/// gets no share.
Table kernel_table(const std::vector<Record>& records, const std::vector<Ceiling>& ceilings);

/// The slowest against their roof, for people.
std::string kernel_text(const Table& table);

} // namespace dss
