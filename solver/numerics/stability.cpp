#include "solver/numerics/stability.hpp"

#include "solver/error.hpp"
#include "solver/numerics/spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

namespace dss {
namespace {

/// |R(z)| of a Runge-Kutta method: its own table run on y' = z y from y = 1 with h = 1; of the implicit midpoint rule:
/// its equation solved.
double growth(const Method& method, std::complex<double> z) {
  if (method.family == Method::Family::implicit_midpoint) return std::abs((1.0 + z / 2.0) / (1.0 - z / 2.0));
  std::vector<std::complex<double>> y(std::size_t(method.stages) + 1);
  y[0] = 1;
  for (std::size_t s = 0; s < std::size_t(method.stages); ++s) {
    y[s + 1] = 1.0 + z * method.beta[s] * y[s];
    for (std::size_t m = 1; m <= s; ++m) y[s + 1] += method.alpha[s][m] * (y[m] - 1.0);
  }
  return std::abs(y[std::size_t(method.stages)]);
}

/// Spectral radius of one step on x'' + rate x' + omega^2 x = 0 with h = 1.
double spectral_radius(const Method& method, double omega, double rate) {
  const double stiffness = omega * omega;
  if (method.family == Method::Family::leapfrog) {
    // One step of (x, v_half, p): a = -stiffness x - rate p.
    Eigen::Matrix3d step;
    step << 1 - stiffness, 1, -rate, -stiffness, 1, -rate, -1.5 * stiffness, 1, -1.5 * rate;
    return step.eigenvalues().cwiseAbs().maxCoeff();
  }
  const std::complex<double> root = std::sqrt(std::complex<double>(rate * rate / 4 - stiffness));
  return std::max(growth(method, -rate / 2 + root), growth(method, -rate / 2 - root));
}

/// Smallest limit over every mode with frequency <= omega_max and damping <= rate_max. A limit scales as 1 / omega
/// along a ray of constant damping ratio, so the worst mode lies on the outer edges omega = omega_max and rate =
/// rate_max of that rectangle.
double worst_step_limit(const Method& method, double omega_max, double rate_max) {
  constexpr int points = 64;
  double limit = std::min(mode_step_limit(method, omega_max, rate_max), mode_step_limit(method, omega_max, 0));
  if (rate_max == 0) return limit;
  for (int n = 0; n < points; ++n) {
    const double part = double(n) / points;
    limit = std::min({limit, mode_step_limit(method, omega_max, part * rate_max),
                      mode_step_limit(method, part * omega_max, rate_max)});
  }
  return limit;
}

} // namespace

double mode_step_limit(const Method& method, double omega, double rate) {
  const double scale = std::max(omega, rate);
  if (scale == 0) return std::numeric_limits<double>::infinity();
  // In steps h * scale. No explicit method of four stages reaches h |lambda| = 20.
  constexpr double increment = 0.02, end = 40;
  const auto is_stable = [&](double h) {
    return spectral_radius(method, h * omega / scale, h * rate / scale) <= 1 + 1e-12;
  };
  double stable = 0, unstable = increment;
  while (is_stable(unstable)) {
    if (unstable > end) return std::numeric_limits<double>::infinity();
    stable = unstable;
    unstable += increment;
  }
  while (unstable - stable > 1e-12 * unstable) {
    const double middle = (stable + unstable) / 2;
    (is_stable(middle) ? stable : unstable) = middle;
  }
  return stable / scale;
}

StabilityLimit stable_step(const Problem& problem, const Method& method, bool sharp) {
  const Spectrum bound = spectrum_bound(problem);
  StabilityLimit limit{0, bound.omega_max, bound.damping, "bound from single links"};
  if (sharp && problem.lattice.element_count > sharp_stability_elements) {
    limit.how += fmt::format(" (more than {} elements: no sharp figure)", sharp_stability_elements);
  } else if (sharp) {
    const Spectrum found = krylov_spectrum(problem);
    limit.omega_max = std::min(found.omega_max, bound.omega_max);
    limit.damping = std::min(found.damping, bound.damping);
    limit.how = fmt::format("Krylov iteration, {} products", found.products);
  }
  if (std::isfinite(limit.omega_max + limit.damping))
    limit.dt = worst_step_limit(method, limit.omega_max, limit.damping);
  if (!(limit.dt > 0))
    throw InputError(
        fmt::format("{}: no stability limit can be found: stiffness over mass or inertia is beyond the range "
                    "of numbers; give constants in SI units",
                    problem.name));
  return limit;
}

} // namespace dss
