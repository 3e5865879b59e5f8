#pragma once
/// Factors of the matrix of implicit stages.
#include "solver/statics/factors.hpp"
#include "variants/api/capabilities.hpp"

namespace dss {

/// Factorises a matrix, given by its lower half, and counts it. Factors::are_complete tells if it
/// is singular.
/// @throws InputError if the factors do not fit in memory
void factorise_step(const Factors::Matrix& lower, Factors& factors, FactorInfo& info);

} // namespace dss
