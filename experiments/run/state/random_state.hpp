#pragma once
/// States for checks, the same on every machine.
#include "kernels/model.hpp"
#include "kernels/precision.hpp"
#include "solver/model/problem.hpp"

#include <vector>

namespace dss {

/// A random state with gaps of a hundredth of an edge, rotations up to 2.5 rad (about z only in the
/// planar model) and velocities; clamped degrees of freedom have none. For f32 it is rounded to
/// float. A seed gives the same state on every machine.
std::vector<double> random_state(const Problem& problem, Model model, Precision precision,
                                 unsigned seed);

} // namespace dss
