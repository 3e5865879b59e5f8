#pragma once
/// Factors of the matrix of implicit stages.
#include "solver/statics/factors.hpp"

namespace dss {

/// Factorises a matrix, given by its lower half. Factors::are_complete tells if it is singular.
/// @return time it took [s]
/// @throws InputError if the factors do not fit in memory
double factorise_step(const Factors::Matrix& lower, Factors& factors);

} // namespace dss
