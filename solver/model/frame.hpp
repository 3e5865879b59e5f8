#pragma once
/// A frame that rotates. Displacements, rotations and velocities of elements are relative to it.
#include "solver/model/problem.hpp"

#include <Eigen/Core>

namespace dss {

/// How the frame stands and turns at a time.
struct FrameTurn {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< its axes in fixed ones, as columns
  /// Angular velocity [rad/s] and its derivative [rad/s^2], along its own axes.
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), acceleration = Eigen::Vector3d::Zero();
};

/// With the rotation vector r of length p, and [r] the matrix of the cross product with it:
///   axes = exp [r] = I + sin p / p [r] + a [r]^2
///   rate = J r',   J = I - a [r] + b [r]^2,   acceleration = J' r' + J r''
///   a = (1 - cos p) / p^2,   b = (p - sin p) / p^3
FrameTurn turn_of_frame(const Problem& problem, double t);

} // namespace dss
