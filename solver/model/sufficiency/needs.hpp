#pragma once
/// What of the equations a problem needs when it is computed with a model, and why not the rest.
#include "solver/model/model.hpp"
#include "solver/model/problem.hpp"

#include <string>
#include <vector>

namespace dss {

struct Need {
  std::string name;
  bool is_needed = false;
  std::string why; ///< one line, either way
};

/// Of the six degrees of freedom of an element. What a clamp holds everywhere is not needed.
std::vector<Need> degrees_of_freedom(const Problem& problem, Model model);

/// Damping, bending and twisting stiffness, orthotropy, tensor inertia, ties, loads, gravity and base motion, initial motions, links outside the grid.
std::vector<Need> terms(const Problem& problem, Model model);

} // namespace dss
