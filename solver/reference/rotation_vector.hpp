#pragma once
/// Rotation vectors (axis times angle [rad]) from and to quaternions, without cancellation near
/// rest.
#include "solver/reference/orientation.hpp"

#include <cmath>

namespace dss::reference {

/// Unit quaternion of a rotation vector theta [rad].
template <class T>
Orientation<T> orientation_of_vector(const Vector<T>& theta) {
  const T angle = theta.norm();
  if (angle == T(0)) return {};
  const T quarter = std::sin(angle / T(4));
  return {-T(2) * quarter * quarter, std::sin(angle / T(2)) / angle * theta};
}

/// Inverse of orientation_of_vector, for angles up to 360 degrees. Any |q| > 0 is valid.
template <class T>
Vector<T> vector_of_orientation(const Orientation<T>& q) {
  const T sine = q.v.norm();
  if (sine == T(0)) return Vector<T>::Zero();
  return T(2) * std::atan2(sine, q.q0()) / sine * q.v;
}

/// dq/dt of q = orientation_of_vector(theta) with theta' = w.
template <class T>
Orientation<T> rate_along_vector(const Vector<T>& theta, const Vector<T>& w) {
  const T angle = theta.norm(), along = theta.dot(w);
  const T half = angle == T(0) ? T(0.5) : std::sin(angle / T(2)) / angle;
  // (cos(angle/2)/2 - half) / angle^2; a series for small angles, where the subtraction would
  // cancel
  const T slope = angle < T(1e-3) ? angle * angle / T(960) - T(1) / T(24)
                                  : (std::cos(angle / T(2)) / T(2) - half) / (angle * angle);
  return {-half * along / T(2), half * w + slope * along * theta};
}

} // namespace dss::reference
