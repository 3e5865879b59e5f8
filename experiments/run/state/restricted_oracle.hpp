#pragma once
/// Computes, by the oracle, the result of a model on a scene that the model is not sufficient for.
/// No variant needs to run it.
#include "kernels/model.hpp"
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <vector>

namespace dss {

/// Final state of a run in double. All degrees of freedom that the model lacks are held at rest,
/// and rotations are described as in the model.
/// @throws UnstableError if the state becomes non-finite
std::vector<double> restricted_state(const Problem& problem, Model model, const Method& method,
                                     double dt, long steps);

} // namespace dss
