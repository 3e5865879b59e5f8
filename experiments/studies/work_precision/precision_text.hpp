#pragma once
/// What a study of work against precision says at its end.
#include "experiments/base/records.hpp"
#include "experiments/studies/work_precision/precision_study.hpp"

#include <string>

namespace dss {

/// The table of points, the cheapest point of each tolerance and the comparisons, for people.
std::string precision_text(const PrecisionStudy& study, const Table& points, const Table& cheapest,
                           const Table& comparisons);

} // namespace dss
