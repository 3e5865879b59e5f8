#include "solver/model/frame.hpp"

#include <cmath>

namespace dss {
namespace {

/// a and b of frame.hpp, and their derivatives by p^2.
struct Shares {
  double a, b, da, db;
};
Shares shares_of(double p2) {
  constexpr double small = 0.04; // below, the series are right to rounding
  if (p2 < small)
    return {1. / 2 - p2 * (1. / 24 - p2 * (1. / 720 - p2 * (1. / 40320 - p2 / 3628800))),
            1. / 6 - p2 * (1. / 120 - p2 * (1. / 5040 - p2 * (1. / 362880 - p2 / 39916800))),
            -1. / 24 +
                p2 * (2. / 720 - p2 * (3. / 40320 - p2 * (4. / 3628800 - p2 * 5 / 479001600))),
            -1. / 120 +
                p2 * (2. / 5040 - p2 * (3. / 362880 - p2 * (4. / 39916800 - p2 * 5 / 6227020800)))};
  const double p = std::sqrt(p2), a = (1 - std::cos(p)) / p2, b = (p - std::sin(p)) / (p2 * p);
  return {a, b, (std::sin(p) / p - 2 * a) / (2 * p2), (a - 3 * b) / (2 * p2)};
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& r) {
  Eigen::Matrix3d m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
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
  const Eigen::Matrix3d x = cross_matrix(r), x1 = cross_matrix(first), xx = x * x,
                        identity = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d j = identity - a * x + b * xx;
  const Eigen::Matrix3d j1 = -a * x1 - da * growth * x + b * (x1 * x + x * x1) + db * growth * xx;
  // sin p / p = 1 - b p^2
  return {identity + (1 - b * p2) * x + a * xx, j * first, j1 * first + j * second};
}

} // namespace dss
