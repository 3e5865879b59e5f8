#pragma once
/// The error budget of a scene: the errors caused by the time step, the grid, rounding, the model
/// and the rotations, side by side.
#include "experiments/base/records.hpp"
#include "experiments/studies/error_budget/error_budget_study.hpp"

#include <functional>
#include <string>

namespace dss {

/// Computes all errors of a study, one row for each source of error. `error` is relative: the
/// largest error of displacements over the saved times. If an error cannot be computed, its row has
/// the reason.
/// @param note  receives a line of text for each computation; may be empty
Table error_budget_table(const ErrorBudgetStudy& study,
                         const std::function<void(const std::string&)>& note);

/// The table as text. It also compares the error of each scene's step with its other errors.
std::string error_budget_text(const ErrorBudgetStudy& study, const Table& table);

} // namespace dss
