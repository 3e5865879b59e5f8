#pragma once
/// Orientations of the oracle: unit quaternions q = (1 + s, v). They store s = q0 - 1, so a small
/// rotation loses no digit.
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace dss::reference {

template <class T>
using Vector = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix = Eigen::Matrix<T, 3, 3>;

/// A unit quaternion (1 + s, v).
template <class T>
struct Orientation {
  T s = 0;                         ///< q0 - 1
  Vector<T> v = Vector<T>::Zero(); ///< vector part
  T q0() const { return T(1) + s; }
};

/// [v]x, the matrix of the cross product v x (...).
template <class T>
Matrix<T> cross_matrix(const Vector<T>& v) {
  Matrix<T> m;
  m << T(0), -v.z(), v.y(), v.z(), T(0), -v.x(), -v.y(), v.x(), T(0);
  return m;
}

/// b (x) a: rotation a, then rotation b.
template <class T>
Orientation<T> product(const Orientation<T>& b, const Orientation<T>& a) {
  return {b.s + a.s + b.s * a.s - b.v.dot(a.v), b.q0() * a.v + a.q0() * b.v + b.v.cross(a.v)};
}

/// A - I of the rotation matrix A = I + 2 q0 [v]x + 2 [v]x^2. Every entry is as small as the
/// rotation.
template <class T>
Matrix<T> turn(const Orientation<T>& q) {
  const Matrix<T> x = cross_matrix<T>(q.v);
  return T(2) * q.q0() * x + T(2) * x * x;
}

/// Vector part of q_j conj(q_i). If the rotation from i to j is small, it is half its rotation
/// vector.
template <class T>
Vector<T> relative_vector(const Orientation<T>& i, const Orientation<T>& j) {
  return (j.v - i.v) + i.s * j.v - j.s * i.v + i.v.cross(j.v);
}

/// Scalar part of q_j conj(q_i).
template <class T>
T relative_scalar(const Orientation<T>& i, const Orientation<T>& j) {
  return i.q0() * j.q0() + i.v.dot(j.v);
}

/// 1 - relative_scalar for unit quaternions, without cancellation.
template <class T>
T relative_versine(const Orientation<T>& i, const Orientation<T>& j) {
  const T ds = j.s - i.s;
  return (ds * ds + (j.v - i.v).squaredNorm()) / T(2);
}

/// q / |q|, without cancellation near rest.
template <class T>
Orientation<T> of_unit_length(const Orientation<T>& q) {
  const T excess = q.s * (T(2) + q.s) + q.v.squaredNorm(); // |q|^2 - 1
  const T length = std::sqrt(T(1) + excess);
  return {(q.s - excess / (T(1) + length)) / length, q.v / length};
}

/// dq/dt = 1/2 w (x) q for the angular velocity w [rad/s] in the global frame.
template <class T>
Orientation<T> rate(const Orientation<T>& q, const Vector<T>& w) {
  return {-w.dot(q.v) / T(2), (q.q0() * w + w.cross(q.v)) / T(2)};
}

/// q after a turn by the Cayley map: dq (x) q with dq = ((1 - b.b) / (1 + b.b), 2 b / (1 + b.b)),
/// b = rotation / 4. |dq| = 1 for every rotation vector [rad]. It agrees with the exact turn to
/// second order.
template <class T>
Orientation<T> cayley_turned(const Orientation<T>& q, const Vector<T>& rotation) {
  const Vector<T> b = rotation / T(4);
  const T bb = b.squaredNorm();
  const T ds = -T(2) * bb / (T(1) + bb);
  const Vector<T> dv = T(2) / (T(1) + bb) * b;
  return {q.s + ds + ds * q.s - dv.dot(q.v), q.v + ds * q.v + q.q0() * dv + dv.cross(q.v)};
}

} // namespace dss::reference
