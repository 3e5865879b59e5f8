#pragma once
/// The error budget of scenes: what time stepping, space discretisation, rounding and the choice of model and rotations each cost in
/// accuracy, side by side.
#include "experiments/runner/precision/error_budget_study.hpp"
#include "experiments/runner/records.hpp"

#include <functional>
#include <string>

namespace dss {

/// Computes all errors of a study. One row a source: `error` is relative, the largest of displacements over the saved times. What
/// cannot be computed keeps its row with the reason.
/// @param note  is told what is computed; may be empty
Table error_budget_table(const ErrorBudgetStudy& study, const std::function<void(const std::string&)>& note);

/// The table for people, with what the step of each scene buys.
std::string error_budget_text(const ErrorBudgetStudy& study, const Table& table);

} // namespace dss
