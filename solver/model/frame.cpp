#include "solver/model/frame.hpp"

#include "solver/reference/orientation.hpp"

#include <cmath>

namespace dss {
namespace {

/// a and b of frame.hpp, and their derivatives by p^2.
struct Shares {
  double a, b, da, db;
};
/// By the series a = sum of (-p^2)^k / (2k + 2)!, b = sum of (-p^2)^k / (2k + 3)!, where the closed
/// forms would lose digits.
Shares series(double p2) {
  constexpr int terms = 10; // right to rounding up to p = 1
  Shares sum{};
  double power = 1, before = 0, factorial = 2; // (-p^2)^k, (-p^2)^(k - 1), (2k + 2)!
  for (int k = 0; k < terms; ++k) {
    const double of_b = factorial * (2 * k + 3);
    sum.a += power / factorial;
    sum.b += power / of_b;
    sum.da -= k * before / factorial;
    sum.db -= k * before / of_b;
    before = power;
    power *= -p2;
    factorial = of_b * (2 * k + 4);
  }
  return sum;
}

Shares shares_of(double p2) {
  if (p2 < 1) return series(p2);
  const double p = std::sqrt(p2), a = (1 - std::cos(p)) / p2, b = (p - std::sin(p)) / (p2 * p);
  return {a, b, (std::sin(p) / p - 2 * a) / (2 * p2), (a - 3 * b) / (2 * p2)};
}

} // namespace

FrameTurn turn_of_frame(const Problem& problem, double t) {
  Eigen::Vector3d r, first, second;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const SignalMotion m = motion_of(problem.frame_rotation[std::size_t(axis)], t);
    r[axis] = m.value, first[axis] = m.rate, second[axis] = m.acceleration;
  }
  const double p2 = r.squaredNorm(), growth = 2 * r.dot(first); // of p^2
  const auto [a, b, da, db] = shares_of(p2);
  const Eigen::Matrix3d x = reference::cross_matrix<double>(r),
                        x1 = reference::cross_matrix<double>(first), xx = x * x,
                        identity = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d j = identity - a * x + b * xx;
  const Eigen::Matrix3d j1 = -a * x1 - da * growth * x + b * (x1 * x + x * x1) + db * growth * xx;
  // sin p / p = 1 - b p^2
  return {identity + (1 - b * p2) * x + a * xx, j * first, j1 * first + j * second};
}

} // namespace dss
