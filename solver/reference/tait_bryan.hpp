#pragma once
/// The paper's angles (its eq. 2): Tait-Bryan X-Y-Z, A = X(phi) Y(theta) Z(psi), as a vector (phi,
/// theta, psi) [rad].
#include "solver/reference/orientation.hpp"

#include <cmath>

namespace dss::reference {

/// Rotation by `angle` [rad] about a coordinate axis.
template <class T>
Orientation<T> turn_about(int axis, T angle) {
  const T quarter = std::sin(angle / T(4));
  return {-T(2) * quarter * quarter, Vector<T>::Unit(axis) * std::sin(angle / T(2))};
}

/// Unit quaternion of the angles (phi, theta, psi) [rad].
template <class T>
Orientation<T> orientation_of_angles(const Vector<T>& angles) {
  return product(product(turn_about<T>(0, angles.x()), turn_about<T>(1, angles.y())),
                 turn_about<T>(2, angles.z()));
}

/// Angles of an orientation, with theta within 90 degrees. At theta = 90 degrees only phi + psi or
/// phi - psi is determined.
template <class T>
Vector<T> angles_of(const Orientation<T>& q) {
  const Matrix<T> a = Matrix<T>::Identity() + turn(q);
  return {std::atan2(-a(1, 2), a(2, 2)), std::atan2(a(0, 2), std::hypot(a(0, 0), a(0, 1))),
          std::atan2(-a(0, 1), a(0, 0))};
}

/// Kinematic equations: rates of the angles [rad/s] for the angular velocity w [rad/s] in the
/// global frame,
///   w = phi' e_x + theta' X(phi) e_y + psi' X(phi) Y(theta) e_z
/// They are singular at cos(theta) = 0.
template <class T>
Vector<T> angle_rates(const Vector<T>& angles, const Vector<T>& w) {
  const T c = std::cos(angles.x()), s = std::sin(angles.x());
  const T psi_rate = (c * w.z() - s * w.y()) / std::cos(angles.y());
  return {w.x() - std::sin(angles.y()) * psi_rate, c * w.y() + s * w.z(), psi_rate};
}

} // namespace dss::reference
