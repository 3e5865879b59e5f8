#include "solver/numerics/step_growth.hpp"

#include "solver/numerics/dense_eigen.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dss {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// First argument, upwards from 0, at which radius(argument) exceeds 1. The search ends at about 4
/// stages^2: no polynomial of degree `stages` stays below 1 beyond 2 stages^2 on the negative real
/// axis.
template <class Radius>
double first_exit(const Radius& radius, int stages, double enough) {
  // With many stages, the edge of the stability region has no detail finer than this share.
  constexpr double increment = 0.02, share = 1e-3;
  const double end = std::min(enough, 4.0 * stages * stages + 4);
  const auto is_stable = [&](double h) { return radius(h) <= 1 + unseen_growth; };
  double stable = 0, unstable = increment;
  while (is_stable(unstable)) {
    if (unstable > end) return infinite;
    stable = unstable;
    unstable += std::max(increment, share * unstable);
  }
  while (unstable - stable > 1e-12 * unstable) {
    const double middle = (stable + unstable) / 2;
    (is_stable(middle) ? stable : unstable) = middle;
  }
  // Growth that exists at half that step too, but is too small to count, exists at every step.
  constexpr double rounding = 1e-14;
  const bool always_grows =
      stable < increment && radius(stable / 2) > 1 + rounding && radius(stable) > 1;
  return always_grows ? 0 : stable;
}

/// Table of a Runge-Kutta method without its zeros, run from y = 1 for y' = lambda y.
class StabilityFunction {
public:
  explicit StabilityFunction(const Method& method)
      : beta_(method.beta), y_(method.beta.size() + 1, 1.0) {
    for (std::size_t s = 0; s < beta_.size(); ++s) {
      for (std::size_t m = 1; m <= s; ++m)
        if (method.alpha[s][m] != 0) terms_.push_back({m, method.alpha[s][m]});
      ends_.push_back(terms_.size());
    }
  }
  /// |R(z)|, z = h lambda.
  double operator()(std::complex<double> z) const {
    std::size_t term = 0;
    for (std::size_t s = 0; s < beta_.size(); ++s) {
      y_[s + 1] = 1.0 + z * beta_[s] * y_[s];
      for (; term < ends_[s]; ++term)
        y_[s + 1] += terms_[term].weight * (y_[terms_[term].stage] - 1.0);
    }
    return std::abs(y_.back());
  }

private:
  struct Term {
    std::size_t stage;
    double weight;
  };
  std::vector<double> beta_;
  std::vector<Term> terms_;
  std::vector<std::size_t> ends_; ///< end of each stage's terms
  mutable std::vector<std::complex<double>> y_;
};

/// spectral_radius of a Runge-Kutta method; stiffness = (h omega)^2, damping = h rate.
double radius_of(const StabilityFunction& amplification, double stiffness, double damping) {
  const double discriminant = damping * damping / 4 - stiffness;
  const std::complex<double> root = std::sqrt(std::complex<double>(discriminant));
  const double one = amplification(-damping / 2 + root);
  // One root of a conjugate pair is enough.
  return discriminant < 0 ? one : std::max(one, amplification(-damping / 2 - root));
}

} // namespace

double amplification(const Method& method, std::complex<double> z) {
  return StabilityFunction(method)(z);
}

double spectral_radius(const Method& method, double h, double omega, double rate) {
  const double stiffness = h * h * omega * omega,
               damping = h * rate; // time in units of the step: h = 1
  switch (method.family) {
  case Method::Family::leapfrog: {
    // One step of (x, h v_half, h p), with h^2 a = -stiffness x - damping h p.
    const double s = method.smoothing, of_acceleration = 1 + (1 - s) / 2;
    Eigen::MatrixXd step(3, 3);
    step << 1 - stiffness, 1, -damping, -stiffness, 1, -damping, -of_acceleration * stiffness,
        1 - s, s - of_acceleration * damping;
    return spectral_radius(step);
  }
  case Method::Family::symplectic_euler: {
    Eigen::MatrixXd step(2, 2); // of (x, h v)
    step << 1 - stiffness, 1 - damping, -stiffness, 1 - damping;
    return spectral_radius(step);
  }
  case Method::Family::implicit_midpoint:
  case Method::Family::diagonally_implicit:
  case Method::Family::generalized_alpha:
  case Method::Family::leaps:
    return 1; // at most 1, for every mode that no load excites
  case Method::Family::runge_kutta:
    break;
  }
  return radius_of(StabilityFunction(method), stiffness, damping);
}

double mode_step_limit(const Method& method, double omega, double rate, double enough) {
  const double scale = std::max(omega, rate);
  if (scale == 0 || method.is_unlimited()) return infinite;
  const double w = omega / scale, c = rate / scale;
  const auto exit_of = [&](const auto& radius) {
    return first_exit(radius, method.stages, enough * scale) / scale;
  };
  if (method.family != Method::Family::runge_kutta)
    return exit_of([&](double h) { return spectral_radius(method, h, w, c); });
  const StabilityFunction function(method);
  return exit_of([&](double h) { return radius_of(function, h * h * w * w, h * c); });
}

double root_step_limit(const Method& method, std::complex<double> root, double enough) {
  const double scale = std::abs(root);
  if (scale == 0 || method.is_unlimited()) return infinite;
  const StabilityFunction function(method);
  return first_exit([&](double h) { return function(h * root / scale); }, method.stages,
                    enough * scale) /
         scale;
}

} // namespace dss
