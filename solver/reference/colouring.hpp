#pragma once
/// Which elements may be disturbed together when a Jacobian is found by differences.
#include "solver/model/problem.hpp"

#include <cstddef>
#include <vector>

namespace dss::reference {

/// For every element the elements whose motion its acceleration depends on: itself first, then those that links of the
/// grid and extra links join to it, each once.
std::vector<std::vector<std::size_t>> neighbourhoods(const Problem& problem);

/// Elements in groups of which no two members have a neighbour in common (A. R. Curtis, M. J. D. Powell, J. K. Reid, J.
/// Inst. Maths Applics 13 (1974) 117-119): greedily, in the order of elements.
std::vector<std::vector<std::size_t>> colour_groups(const std::vector<std::vector<std::size_t>>& neighbourhoods);

} // namespace dss::reference
