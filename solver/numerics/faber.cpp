#include "solver/numerics/faber.hpp"

#include "solver/numerics/bessel.hpp"
#include "solver/numerics/butcher_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dss {
namespace {

/// An ellipse with the centre -left, half axes a (along the real axis) and b, and foci at the
/// distance `focus` above and below the centre [1/s].
struct Ellipse {
  double left, half_width, focus, sum; ///< half_width: a; sum: a + b
};

/// In the energy norm, L = [0 Omega; -Omega -C] of a mode with the rate c has its field of values
/// in an ellipse with the centre -c/2 and the half axes c/2 and omega. Those of all modes with c
/// from k D (omega/omega_max)^2 to D are in one with the centre -D/2 and the half axes D/2 and
/// omega_max, both times (2 / (1 + k))^(1/2). A step that is short for it has a larger one: its
/// polynomial needs the degree of the loads, too.
Ellipse ellipse_of(const Spectrum& spectrum, double dt) {
  const double omega = spectrum.omega_max, damping = spectrum.damping;
  const double kept = damping > 0 ? std::min(1.0, spectrum.least_damping * omega * omega / damping)
                                  : 1,
               factor = std::sqrt(2 / (1 + kept));
  constexpr double flattest = 1.05, least_phase = 2; // foci on the imaginary axis need b > a
  const double a = factor * damping / 2,
               b = std::max({factor * omega, flattest * a, least_phase / dt});
  return {damping / 2, a, std::sqrt((b - a) * (b + a)), a + b};
}

/// Weights c_k of exp(h (z - centre)) = sum c_k p_k(z), p_k = i^k T_k of the ellipse; as many as
/// count.
std::vector<double> weights_of(const Ellipse& ellipse, double dt) {
  constexpr double negligible = 1e-15;
  const double z = ellipse.focus * dt, growth = std::log(ellipse.sum / ellipse.focus);
  // J_k(z) is less than (e z / 2k)^k, which makes the products below e^-40 from here on.
  std::vector<double> weights(std::size_t(2 * ellipse.sum * dt) + 60);
  bessel_j(z, weights);
  const auto is_small = [&](std::size_t k) {
    return std::abs(weights[k]) < negligible * std::exp(dt * ellipse.left - growth * double(k));
  };
  std::size_t count = weights.size();
  while (count > 2 && is_small(count - 1)) --count;
  weights.resize(count);
  for (std::size_t k = 1; k < count; ++k) weights[k] *= 2;
  return weights;
}

/// What stages make of the loads t^j, t being 0 to 1 in the step, is what they make of the state of
/// m_j' = j m_(j-1), m_0 = 1.
std::vector<std::array<double, signal_points>> signal_weights_of(const Method& method) {
  constexpr PointPolynomials polynomials = point_polynomials();
  const auto stages = std::size_t(method.stages);
  std::vector<std::array<double, signal_points>> powers(stages), weights(stages);
  for (std::size_t s = 0; s < stages; ++s) {
    powers[s][0] = 1;
    for (std::size_t j = 1; s > 0 && j < signal_points; ++j) {
      double sum = method.beta[s - 1] * double(j) * powers[s - 1][j - 1];
      for (std::size_t m = 1; m < s; ++m) sum += method.alpha[s - 1][m] * powers[m][j];
      powers[s][j] = sum;
    }
    for (std::size_t p = 0; p < signal_points; ++p)
      for (std::size_t j = 0; j < signal_points; ++j)
        weights[s][p] += powers[s][j] * polynomials[p][j];
  }
  return weights;
}

} // namespace

// With Z = (L + left) / focus and p_{k+1} = 2 Z p_k + p_{k-1}, the sum of c_k p_k is c_0 + Z b_1 +
// b_2, where b_k = c_k + 2 Z b_{k+1} + b_{k+2}. s_k is b_k for L = 0.
Method faber(const Spectrum& spectrum, double dt) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Method method{.name = "faber",
                .family = Method::Family::runge_kutta,
                .order = 5,
                .stages = 0,
                .node = {},
                .beta = {},
                .alpha = {},
                .imaginary_limit = infinity,
                .real_limit = infinity,
                .is_symplectic = false,
                .keeps_energy_bounded = true,
                .note =
                    "linear models, exact for loads that are polynomials of degree 4 in a step; "
                    "as many force evaluations a step as its length needs",
                .is_exponential = true};
  if (!(dt > 0)) return method;
  const Ellipse ellipse = ellipse_of(spectrum, dt);
  // Terms grow to the right of the imaginary axis, and cancel.
  constexpr double most_growth = 8;
  const double right = ellipse.half_width - ellipse.left;
  if (!(ellipse.sum * dt <= 2 * most_faber_stages) || !(right * dt <= most_growth)) return method;
  const std::vector<double> c = weights_of(ellipse, dt);
  const int last = int(c.size()) - 1;
  if (last > most_faber_stages) return method;
  double above = 0, here = c.back(); // s_{k+2}, s_{k+1}
  for (int k = last - 1; k >= 0; --k) {
    const double slope = (k == 0 ? 1 : 2) / ellipse.focus;
    const double next = c[std::size_t(k)] + slope * ellipse.left * here + above;
    std::vector<double> alpha(std::size_t(method.stages) + 1);
    if (method.stages > 0) alpha.back() = slope * ellipse.left * here / next;
    if (method.stages > 1) alpha[std::size_t(method.stages) - 1] = above / next;
    method.alpha.push_back(std::move(alpha));
    method.beta.push_back(slope / dt * here / next);
    ++method.stages;
    above = std::exchange(here, next);
  }
  method.node = nodes_of(method.alpha, method.beta);
  method.signal_weights = signal_weights_of(method);
  return method;
}

} // namespace dss
