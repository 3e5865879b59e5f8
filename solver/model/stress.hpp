#pragma once
/// Stress recovery after a run (kernels/stress/stress.h).
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"

#include <array>
#include <span>
#include <vector>

namespace dss {

/// xx, yy, zz, yz, xz, xy and von Mises [Pa], global axes.
using ElementStress = std::array<double, 7>;

/// Stress of every element from the forces of all its links, damping included, at the given state (13 doubles an
/// element), by the links of the equations that it comes from: in others its rotations would strain links that are at rest.
std::vector<ElementStress> element_stress(const Problem& problem, std::span<const double> state, Rotation equations);

} // namespace dss
