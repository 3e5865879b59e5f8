#pragma once
/// The failure atlas: runs every cell, says its verdict, and holds it against the expected one. A method that should fail and does not
/// fails the study as well.
#include "experiments/runner/atlas/failure_case.hpp"
#include "experiments/runner/records.hpp"

#include <string>

namespace dss {

/// A row a cell. `status` is "passed" or "failed"; a cell that no expectation fits is failed.
/// @throws InputError for a case that cannot be computed at all
Table failures_table(const FailureStudy& study);

/// For people: counts, and every failed cell with its reason.
std::string failures_text(const FailureStudy& study, const Table& table);

/// Whether any row of a table failed.
bool has_failed_rows(const Table& table);

} // namespace dss
