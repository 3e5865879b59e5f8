#pragma once
/// Tables of a study of work against precision: one row a point, the cheapest point for each
/// tolerance, and comparisons.
#include "experiments/measure/study_samples.hpp"
#include "experiments/studies/work_precision/precision_study.hpp"

namespace dss {

/// One row a cell. Errors are those of Accuracy; `error_max` is the one that Pareto front and
/// tolerances go by. A point that is unstable, refused, inaccurate (no correct digit) or wrong
/// keeps its row, with the reason.
Table precision_table(const PrecisionStudy& study, const std::vector<Record>& records);

/// For each problem and tolerance the point of the least median time whose error, with the
/// solution's own added, is not above it.
/// @param points  precision_table of the study
Table cheapest_table(const PrecisionStudy& study, const Table& points);

/// Answers the study's comparisons. @param budget  table of the error budget, or empty
Table comparison_table(const PrecisionStudy& study, const Table& points,
                       const std::vector<Record>& records, const Table& budget);

} // namespace dss
