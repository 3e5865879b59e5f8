#pragma once
/// Which degrees of freedom and terms a problem needs under a model, and why.
#include "kernels/model.hpp"
#include "solver/model/problem.hpp"

#include <string>
#include <vector>

namespace dss {

/// A degree of freedom or a term, needed or not.
struct Need {
  std::string name;
  bool is_needed = false;
  std::string why; ///< one line, for needed and not needed
};

/// The six degrees of freedom of an element. One that clamps hold everywhere is not needed.
std::vector<Need> degrees_of_freedom(const Problem& problem, Model model);

/// Terms: damping, bending and twisting stiffness, orthotropy, tensor inertia, ties, loads, gravity
/// and base motion, initial motions, links outside the grid.
std::vector<Need> terms(const Problem& problem, Model model);

} // namespace dss
