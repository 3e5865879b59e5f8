#pragma once
/// Which terms of the equations a problem needs.
#include "kernels/model.hpp"
#include "kernels/terms.hpp"
#include "solver/model/problem.hpp"

#include <vector>

namespace dss {

/// The terms of each body. Terms that depend on velocities are those of all bodies together, so
/// that a leapfrog method keeps the same numbers of every element.
std::vector<Terms> needed_terms(const Problem& problem, Model model);

} // namespace dss
