#pragma once
/// Where the nodes of a body are.
#include "solver/lattice/element_nodes.hpp"
#include "solver/model/problem.hpp"

#include <span>
#include <vector>

namespace dss {

/// Places at rest and displacements of the nodes [m]: means of what the elements at a node have
/// there.
struct NodeMotion {
  std::vector<Vec3> rest, displacement;
};

/// @param state  13 numbers an element
NodeMotion node_motion(const Problem& problem, std::span<const double> state,
                       const ElementNodes& nodes);

} // namespace dss
