#pragma once
/// Energy of a state, for audits.
#include "solver/model/problem.hpp"
#include "solver/model/rotation.hpp"
#include "solver/reference/dynamics.hpp"

#include <span>
#include <vector>

namespace dss {

/// The oracle's terms for the energies of a run. Descriptions of finite rotations share them.
reference::Dynamics<double> energy_terms(const Problem& problem, Rotation rotation);
/// A state in the coordinates of energy_terms. Orientations get the length 1: a method changes it
/// by its error, and what it describes is q / |q|.
/// @param state  field_count numbers an element, with quaternions
std::vector<double> placed(reference::Dynamics<double>& terms, std::span<const double> state);

/// Kinetic energy, elastic energy of all links and energy of the stabilizing springs [J]. Loads and
/// the frame's acceleration do work and are not included. The potentials are in
/// solver/reference/link_law.hpp.
/// @param state     field_count numbers for every element (kernels/fields.hpp)
/// @param rotation  description of rotations in the run; small and linearised rotations have an
///     energy of their own, all others share one
/// @throws InputError if the state has another size
double total_energy(const Problem& problem, std::span<const double> state,
                    Rotation rotation = Rotation::quaternion);

/// True if a link or the stabilization is damped.
bool has_dampers(const Problem& problem);

/// True if total_energy is constant in time: no link or tie is damped, and nothing loads or
/// accelerates the bodies.
bool conserves_energy(const Problem& problem);

} // namespace dss
