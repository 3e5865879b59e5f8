#pragma once
/// What a study of work against precision says at its end.
#include "experiments/runner/records.hpp"
#include "experiments/runner/study.hpp"

#include <string>
#include <vector>

namespace dss {

/// Writes PATH_cheapest.csv and PATH_comparisons.csv beside the table of points (PATH.csv), and gives all three for people. Errors of
/// space discretisation come from error_budget.csv in the same directory, if it is there.
std::string report_precision(const Study& study, const Table& points, const std::vector<Record>& records,
                             const std::string& path);

} // namespace dss
