#pragma once
/// Methods and steps that are verified.
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

namespace dss {

/// True for the methods of brief checks: the paper's method, the leapfrog method whose prediction
/// has all its terms, and an implicit method.
bool is_brief(const Method& method);

/// The scene's step, or a shorter one if the method needs it. A method without a stable step grows
/// too slowly to matter here.
double verified_step(const Problem& problem, const Method& method);

} // namespace dss
