#pragma once
/// Motion of a rigid body without moments, in closed form: the motion of a free element.
#include <Eigen/Geometry>

namespace dss {

/// Orientation (body to space) and angular velocity in space [rad/s].
struct Attitude {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
};

/// Attitude at time t [s] of a body with these principal moments of inertia [kg m^2] about its own
/// axes.
/// All moments equal: steady spin. Two equal: regular precession about the angular momentum. All
/// different: Jacobi's elliptic functions for the spin in the body, and quadrature for the
/// precession about the angular momentum. Source: Landau and Lifshitz, Mechanics, paragraphs 35 and
/// 37.
/// The sign of q follows the continuous motion, except if all moments differ. Not valid for a spin
/// on the separatrix, L^2 = 2 E I_2.
Attitude free_top(const Eigen::Vector3d& inertia, const Attitude& start, double t);

} // namespace dss
