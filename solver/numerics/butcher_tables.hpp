#pragma once
/// Explicit Runge-Kutta methods that were published as Butcher tables.
#include "solver/numerics/method.hpp"

namespace dss {

/// Times of the stages of an explicit table: its result for y' = 1.
std::vector<double> nodes_of(const std::vector<std::vector<double>>& alpha,
                             const std::vector<double>& beta);
/// The methods of this file.
std::vector<Method> butcher_methods();

} // namespace dss
