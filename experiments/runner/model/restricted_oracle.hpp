#pragma once
/// What the equations of a model give on a scene that it does not suffice for, where no variant need run it: by the oracle.
#include "solver/model/model.hpp"
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <vector>

namespace dss {

/// The end of a run in double, with every degree of freedom that the model lacks held at rest, and its description of rotations.
/// @throws UnstableError if it leaves the finite numbers
std::vector<double> restricted_state(const Problem& problem, Model model, const Method& method, double dt, long steps);

} // namespace dss
