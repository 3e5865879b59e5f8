#pragma once
/// Modal analysis: natural frequencies, what moves in each mode, and how much of the mass follows the frame.
#include "solver/statics/eigenmodes.hpp"

#include <vector>

namespace dss {

struct NaturalMode {
  double omega = 0;         ///< [rad/s]; 0 of a rigid motion or a mechanism
  Vec3 effective_mass{};    ///< mass that motions of the frame along x, y, z set swinging in this mode [kg]
  std::size_t element = 0;  ///< where most of its kinetic energy is
  double element_share = 0; ///< that element's share of it
  Eigen::VectorXd shape;    ///< free degrees of freedom [m, rad], x^T M x = 1 kg m^2
};

struct ModalAnalysis {
  std::vector<NaturalMode> modes; ///< with a frequency, ascending
  long free_motions = 0;          ///< modes without stiffness: rigid motions and mechanisms
  Vec3 free_mass{}; ///< of all that may move along x, y, z [kg]: effective masses of all modes sum up to it
};

/// Lowest `count` modes with a frequency, of a system about a state: rest, or an equilibrium (prestress is then in it).
/// @throws InputError for more than 60 modes without stiffness, UnstableError for a state that is not stable
ModalAnalysis find_modes(const StaticSystem& system, int count, const StaticSystem::State& state, bool is_rest);

} // namespace dss
