#pragma once
/// Elements that may be disturbed together when a Jacobian is computed by differences.
#include "solver/model/problem.hpp"

#include <cstddef>
#include <vector>

namespace dss::reference {

/// For every element the elements that its acceleration depends on: first itself, then those joined
/// to it by links of the grid and by extra links, and with pressure those joined to these, each
/// once.
std::vector<std::vector<std::size_t>> neighbourhoods(const Problem& problem);

/// Groups of elements. No two members of a group have a neighbour in common, so one evaluation
/// gives the derivatives by all members. Greedy, in the order of the elements (A. R. Curtis, M. J.
/// D. Powell, J. K. Reid, J. Inst. Maths Applics 13 (1974) 117-119).
std::vector<std::vector<std::size_t>>
colour_groups(const std::vector<std::vector<std::size_t>>& neighbourhoods);

} // namespace dss::reference
