#include "experiments/studies/failures/free_top.hpp"
#include "experiments/studies/failures/elliptic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace dss {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The spin in the body frame. The body axes are numbered so that the spin vector circulates about
/// `fast`.
struct Spin {
  int slow, middle, fast;
  Vector3d amplitude; ///< by body axis; the middle one has the sign of sn
  double k, rate, start;
  Vector3d operator()(double t) const {
    const Jacobi j = jacobi(start + rate * t, k);
    Vector3d w;
    w[slow] = amplitude[slow] * j.cn;
    w[middle] = amplitude[middle] * j.sn;
    w[fast] = amplitude[fast] * j.dn;
    return w;
  }
};

Spin spin_of(const Vector3d& I, const Vector3d& w) {
  std::array<int, 3> axis = {0, 1, 2};
  std::sort(axis.begin(), axis.end(), [&](int a, int b) { return I[a] < I[b]; });
  const double twice_energy = I.dot(w.cwiseAbs2()),
               squared_momentum = I.cwiseProduct(w).squaredNorm();
  if (squared_momentum < twice_energy * I[axis[1]]) std::swap(axis[0], axis[2]);
  const auto [a, b, c] = axis;
  const double from_fast = twice_energy * I[c] - squared_momentum,
               from_slow = squared_momentum - twice_energy * I[a];
  // Euler's equations change sign if the three axes are left-handed.
  const double hand = (b - a + 3) % 3 == 1 ? 1 : -1, side = w[c] < 0 ? -1 : 1;
  Spin spin{a, b, c, {}, 0, 0, 0};
  spin.amplitude[a] = std::sqrt(from_fast / (I[a] * (I[c] - I[a])));
  spin.amplitude[b] = std::sqrt(from_fast / (I[b] * (I[c] - I[b])));
  spin.amplitude[c] = side * std::sqrt(from_slow / (I[c] * (I[c] - I[a])));
  spin.k = std::sqrt((I[b] - I[a]) * from_fast / ((I[c] - I[b]) * from_slow));
  spin.rate = std::sqrt((I[c] - I[b]) * from_slow / (I[a] * I[b] * I[c]));
  spin.amplitude[b] *= hand * side * (I[c] > I[a] ? 1 : -1);
  spin.start =
      std::ellint_1(spin.k, std::atan2(w[b] / spin.amplitude[b], w[a] / spin.amplitude[a]));
  return spin;
}

/// Matrix with the columns l (direction of the angular momentum), `across`, and their cross
/// product.
Matrix3d triad(const Vector3d& l, const Vector3d& across) {
  Matrix3d m;
  m << l, across, l.cross(across);
  return m;
}

Attitude asymmetric_top(const Vector3d& I, const Attitude& start, double t) {
  const Matrix3d from_body = start.q.toRotationMatrix();
  const Vector3d w0 = from_body.transpose() * start.w, momentum = from_body * I.cwiseProduct(w0);
  const Spin spin = spin_of(I, w0);
  const double L = momentum.norm();
  const Vector3d axis = Vector3d::Unit(spin.fast), up = momentum / L;
  const auto precession = [&](double at) {
    const Vector3d w = spin(at);
    const double a = I[spin.slow] * w[spin.slow], b = I[spin.middle] * w[spin.middle];
    return L * (a * w[spin.slow] + b * w[spin.middle]) / (a * a + b * b);
  };
  constexpr int panels = 4000; // for Simpson's rule; the integrand is smooth
  double sum = precession(0) + precession(t);
  for (int n = 1; n < 2 * panels; ++n)
    sum += (n % 2 == 1 ? 4 : 2) * precession(t * n / (2 * panels));
  const double angle = sum * t / (6 * panels);
  const auto in_body = [&](const Vector3d& w) {
    const Vector3d l = I.cwiseProduct(w) / L;
    return triad(l, l.cross(axis).normalized());
  };
  const Vector3d across = from_body * in_body(w0).col(1), w = spin(t);
  const Matrix3d turned = triad(up, AngleAxisd(angle, up) * across) * in_body(w).transpose();
  return {Eigen::Quaterniond(turned), turned * w};
}

/// For two or three equal moments of inertia; `axis` is the symmetry axis.
Attitude symmetric_top(const Vector3d& I, int axis, const Attitude& start, double t) {
  const double across = I[(axis + 1) % 3];
  const Vector3d in_body = start.q.conjugate() * start.w;
  const Vector3d precession = start.q * I.cwiseProduct(in_body) / across;
  const double own = in_body[axis] * (1 - I[axis] / across), rate = precession.norm();
  if (rate == 0) return start;
  const Eigen::Quaterniond turned =
      AngleAxisd(rate * t, precession / rate) * start.q * AngleAxisd(own * t, Vector3d::Unit(axis));
  return {turned, precession + own * (turned * Vector3d::Unit(axis))};
}

} // namespace

Attitude free_top(const Vector3d& inertia, const Attitude& start, double t) {
  for (const int axis : {0, 1, 2})
    if (std::abs(inertia[(axis + 1) % 3] - inertia[(axis + 2) % 3]) <= 1e-12 * inertia.maxCoeff())
      return symmetric_top(inertia, axis, start, t);
  return asymmetric_top(inertia, start, t);
}

} // namespace dss
