#pragma once
/// Stress and strain as files of VTK have them.
#include "solver/lattice/element_nodes.hpp"
#include "solver/model/stress/stress_field.hpp"

#include <vector>

namespace dss {

/// Stress and strain of a state, as written.
struct StressOutput {
  std::vector<ElementStress> elements;
  ElementNodes nodes;
  std::vector<SymmetricTensor> at_nodes; ///< stress of each node [Pa]
};

} // namespace dss
