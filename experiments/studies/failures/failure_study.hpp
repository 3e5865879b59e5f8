#pragma once
/// Runs every cell of the failure atlas and compares its verdict with the expected one. A method
/// that should fail but succeeds is also a failure of the study.
#include "experiments/base/records.hpp"
#include "experiments/studies/failures/failure_case.hpp"

#include <string>

namespace dss {

/// One row for each cell. `status` is "passed" or "failed"; a cell without an expectation is
/// failed.
/// @throws InputError for a case that cannot be computed at all
Table failures_table(const FailureStudy& study);

/// Text with counts, and every failed cell with its reason.
std::string failures_text(const FailureStudy& study, const Table& table);

} // namespace dss
