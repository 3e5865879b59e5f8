#pragma once
/// Where exponential methods can be used, and what signals they need.
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <string>

namespace dss {

/// Requires a method that is not exponential. @throws InputError
const Method& require_stepwise(const Method& method);

/// Why the signals are not polynomials of degree 4 in each step, and a step in which they are: one
/// has a kink within a step, or a step is too long for a harmonic. Empty if they are.
/// @param dt  [s]
std::string why_not_polynomial(const Problem& problem, double dt, long steps);

} // namespace dss
