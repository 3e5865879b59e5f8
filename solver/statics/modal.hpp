#pragma once
/// Modal analysis: natural frequencies, the element that moves most in each mode, and the mass that
/// follows the frame.
#include "solver/statics/eigenmodes.hpp"

#include <vector>

namespace dss {

/// One natural mode.
struct NaturalMode {
  double omega = 0; ///< [rad/s]; 0 for a rigid motion or a mechanism
  /// Effective mass of this mode for motions of the frame along x, y, z [kg].
  Vec3 effective_mass{};
  std::size_t element = 0;  ///< element with most of the kinetic energy
  double element_share = 0; ///< share of that element in the kinetic energy
  Eigen::VectorXd shape;    ///< free degrees of freedom [m, rad], x^T M x = 1 kg m^2
};

/// Result of a modal analysis.
struct ModalAnalysis {
  std::vector<NaturalMode> modes; ///< modes with a frequency, ascending
  long free_motions = 0;          ///< modes without stiffness (rigid motions, mechanisms)
  /// Mass of all that may move along x, y, z [kg]. The effective masses of all modes add up to it.
  Vec3 free_mass{};
};

/// Lowest `count` modes with a frequency, of a system about a state: rest, or an equilibrium (with
/// its prestress).
/// @throws InputError for more than 60 modes without stiffness
/// @throws UnstableError if the state is not stable
ModalAnalysis find_modes(const StaticSystem& system, int count, const StaticSystem::State& state,
                         bool is_rest);

} // namespace dss
