#pragma once
/// Energy of a state, for audits.
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"

#include <span>

namespace dss {

/// Kinetic energy, elastic energy of all links and energy of the stabilizing springs [J]. Loads and
/// the frame's acceleration do work and are not included. The potentials are in
/// solver/reference/link_law.hpp.
/// @param state     field_count numbers for every element (kernels/fields.hpp)
/// @param rotation  description of rotations in the run; small and linearised rotations have an
///     energy of their own, all others share one
/// @throws InputError if the state has another size
double total_energy(const Problem& problem, std::span<const double> state,
                    Rotation rotation = Rotation::quaternion);

/// True if total_energy is constant in time: no link or tie is damped, and nothing loads or
/// accelerates the bodies.
bool conserves_energy(const Problem& problem);

} // namespace dss
