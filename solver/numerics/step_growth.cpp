#include "solver/numerics/step_growth.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dss {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// First argument, upwards from 0, at which radius(argument) exceeds 1, of a method of so many stages: no polynomial of
/// their degree stays below 1 for longer than 2 stages^2 on the negative real axis.
template <class Radius>
double first_exit(const Radius& radius, int stages, double enough) {
  constexpr double increment = 0.02;
  const double end = std::min(enough, 4.0 * stages * stages + 4);
  const auto is_stable = [&](double h) { return radius(h) <= 1 + unseen_growth; };
  double stable = 0, unstable = increment;
  while (is_stable(unstable)) {
    if (unstable > end) return infinite;
    stable = unstable;
    unstable += increment;
  }
  while (unstable - stable > 1e-12 * unstable) {
    const double middle = (stable + unstable) / 2;
    (is_stable(middle) ? stable : unstable) = middle;
  }
  // A growth that is there at half that step too, only too small to count, is there at every step.
  constexpr double rounding = 1e-14;
  const bool always_grows = stable < increment && radius(stable / 2) > 1 + rounding && radius(stable) > 1;
  return always_grows ? 0 : stable;
}

} // namespace

double amplification(const Method& method, std::complex<double> z) {
  std::vector<std::complex<double>> y(std::size_t(method.stages) + 1);
  y[0] = 1;
  for (std::size_t s = 0; s < std::size_t(method.stages); ++s) {
    y[s + 1] = 1.0 + z * method.beta[s] * y[s];
    for (std::size_t m = 1; m <= s; ++m) y[s + 1] += method.alpha[s][m] * (y[m] - 1.0);
  }
  return std::abs(y[std::size_t(method.stages)]);
}

double spectral_radius(const Method& method, double h, double omega, double rate) {
  const double stiffness = h * h * omega * omega, damping = h * rate; // a mode in steps: h = 1
  switch (method.family) {
  case Method::Family::leapfrog: {
    // One step of (x, h v_half, h p): h^2 a = -stiffness x - damping h p.
    Eigen::Matrix3d step;
    step << 1 - stiffness, 1, -damping, -stiffness, 1, -damping, -1.5 * stiffness, 1, -1.5 * damping;
    return step.eigenvalues().cwiseAbs().maxCoeff();
  }
  case Method::Family::symplectic_euler: {
    Eigen::Matrix2d step; // of (x, h v)
    step << 1 - stiffness, 1 - damping, -stiffness, 1 - damping;
    return step.eigenvalues().cwiseAbs().maxCoeff();
  }
  case Method::Family::implicit_midpoint:
    return 1; // at most, for every mode that is not excited
  case Method::Family::runge_kutta:
    break;
  }
  const std::complex<double> root = std::sqrt(std::complex<double>(damping * damping / 4 - stiffness));
  return std::max(amplification(method, -damping / 2 + root), amplification(method, -damping / 2 - root));
}

double mode_step_limit(const Method& method, double omega, double rate, double enough) {
  const double scale = std::max(omega, rate);
  if (scale == 0 || method.is_implicit()) return infinite;
  return first_exit([&](double h) { return spectral_radius(method, h, omega / scale, rate / scale); }, method.stages,
                    enough * scale) /
         scale;
}

double root_step_limit(const Method& method, std::complex<double> root, double enough) {
  const double scale = std::abs(root);
  if (scale == 0) return infinite;
  return first_exit([&](double h) { return amplification(method, h * root / scale); }, method.stages, enough * scale) /
         scale;
}

} // namespace dss
