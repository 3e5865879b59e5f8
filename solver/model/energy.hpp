#pragma once
/// Energy of a state, for audits.
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"

#include <span>

namespace dss {

/// Kinetic energy, elastic energy of all links and energy of the stabilizing springs [J]. Loads and the frame's
/// acceleration have no part in it: they do work. Potentials: solver/reference/link_law.hpp.
/// @param state     field_count numbers for every element (solver/model/fields.hpp)
/// @param rotation  of the run: small rotations have an energy of their own, the other ways to describe one share theirs
/// @throws InputError if the state has another size
double total_energy(const Problem& problem, std::span<const double> state, Rotation rotation = Rotation::quaternion);

/// Whether total_energy is constant in time: no link or tie is damped, nothing loads or accelerates the bodies.
bool conserves_energy(const Problem& problem);

} // namespace dss
