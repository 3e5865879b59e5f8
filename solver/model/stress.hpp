#pragma once
/// Stress recovery after a run (kernels/stress/stress.h).
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"

#include <array>
#include <span>
#include <vector>

namespace dss {

/// xx, yy, zz, yz, xz, xy and von Mises stress [Pa], in global axes.
using ElementStress = std::array<double, 7>;

/// Stress of every element from the forces of all its links, damping and pressure included. What
/// loads on faces add to the pressure (Load::face_strain) is left out.
/// @param state  13 numbers an element (kernels/fields.hpp)
/// @param equations  equations that the state comes from; links of other equations would be
///     strained by its rotations even at rest
/// @return one ElementStress for each element
std::vector<ElementStress> element_stress(const Problem& problem, std::span<const double> state,
                                          Rotation equations);

} // namespace dss
