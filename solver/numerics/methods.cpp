/// Methods that are written as formulas, and the lists of all.
#include "solver/numerics/butcher_tables.hpp"
#include "solver/numerics/faber.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dss {
namespace {

// Built on first use: methods() may be called before the static objects of this file exist.

/// Classical RK4 without a running sum (DESIGN.md section 3):
///   y1 = y + h/2 k1,  y2 = y + h/2 k2,  y3 = y + h k3
///   y(n+1) = (y1 + 2 y2 + y3 - y)/3 + h/6 k4
/// Its limits are the roots of |R(z)| = 1, R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24.
Method rk4() {
  constexpr double third = 1.0 / 3, sixth = 1.0 / 6;
  return {.name = "rk4",
          .family = Method::Family::runge_kutta,
          .order = 4,
          .stages = 4,
          .node = {0, 0.5, 0.5, 1},
          .beta = {0.5, 0.5, 1, sixth},
          .alpha = {{0}, {0, 0}, {0, 0, 0}, {0, third, 2 * third, third}},
          .imaginary_limit = 2.8284271247461903,
          .real_limit = 2.785293563405282,
          .is_symplectic = false,
          .keeps_energy_bounded = false,
          .note = "classical fourth-order Runge-Kutta; four force evaluations a step"};
}

/// y1 = y + h/2 k1, y(n+1) = y + h k2.
Method midpoint() {
  return {.name = "midpoint",
          .family = Method::Family::runge_kutta,
          .order = 2,
          .stages = 2,
          .node = {0, 0.5},
          .beta = {0.5, 1},
          .alpha = {{0}, {0, 0}},
          .imaginary_limit = 0,
          .real_limit = 2,
          .is_symplectic = false,
          .keeps_energy_bounded = false,
          .note = "two force evaluations a step; an undamped mode grows by (h omega)^4 / 8 a step, "
                  "whatever the step"};
}

Method symplectic_euler() {
  return {.name = "symplectic_euler",
          .family = Method::Family::symplectic_euler,
          .order = 1,
          .stages = 1,
          .node = {0},
          .beta = {1},
          .alpha = {{0}},
          .imaginary_limit = 2,
          .real_limit = 2,
          .is_symplectic = true,
          .keeps_energy_bounded = true,
          .note = "one force evaluation a step, no extra memory; first order, but its energy "
                  "stays bounded"};
}

/// The mode that changes sign in every step, x = -1, 1, -1, ..., sets the limits. For it v = 2x/h,
/// and p = 4x/h / (1 + smoothing) half a step before. With h^2 a = -4x that gives
/// (h omega)^2 + 4 / (1 + smoothing) h rate = 4. No other mode leaves the unit circle earlier.
Method leapfrog(std::string_view name, double smoothing, std::string_view note) {
  return {.name = name,
          .family = Method::Family::leapfrog,
          .order = 2,
          .stages = 1,
          .node = {0},
          .beta = {1},
          .alpha = {{0}},
          .imaginary_limit = 2,
          .real_limit = 1 + smoothing,
          .is_symplectic = true,
          .keeps_energy_bounded = true,
          .note = note,
          .smoothing = smoothing};
}

Method velocity_verlet() {
  return leapfrog("velocity_verlet", 0,
                  "one force evaluation a step; damping and gyroscopic terms see a predicted "
                  "velocity, which lowers the "
                  "step limit of damped problems");
}

Method smoothed_verlet() {
  return leapfrog("smoothed_verlet", 0.75,
                  "velocity_verlet with a prediction from the mean of past accelerations: a larger "
                  "step for damped problems, "
                  "but four times the error of velocity-dependent terms; not for fast spins (28 "
                  "times the growth)");
}

constexpr double infinity = std::numeric_limits<double>::infinity();

Method implicit_midpoint() {
  return {.name = "implicit_midpoint",
          .family = Method::Family::implicit_midpoint,
          .order = 2,
          .stages = 1,
          .node = {0.5},
          .beta = {1},
          .alpha = {{0}},
          .imaginary_limit = infinity,
          .real_limit = infinity,
          .is_symplectic = true,
          .keeps_energy_bounded = true,
          .note = "solves the equations of each step to rounding by Newton's iteration; any step "
                  "is stable, but modes "
                  "that it does not resolve are slowed down and hardly damped"};
}

/// Newmark's method with beta = 1/4 and gamma = 1/2 (average acceleration), which is the
/// trapezoidal rule. N. M. Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67-94.
Method newmark() {
  return {.name = "newmark",
          .family = Method::Family::diagonally_implicit,
          .order = 2,
          .stages = 2,
          .node = {0, 1},
          .beta = {0, 0.5},
          .alpha = {{}, {0.5}},
          .imaginary_limit = infinity,
          .real_limit = infinity,
          .is_symplectic = true,
          .keeps_energy_bounded = true,
          .note = "average acceleration, the trapezoidal rule: one solution a step; any step is "
                  "stable, but modes that it does not resolve are slowed down and hardly damped"};
}

/// L-stable method of order 4 with five stages. E. Hairer, G. Wanner, Solving Ordinary Differential
/// Equations II, table IV.6.5.
Method sdirk4() {
  return {.name = "sdirk4",
          .family = Method::Family::diagonally_implicit,
          .order = 4,
          .stages = 5,
          .node = {1. / 4, 3. / 4, 11. / 20, 1. / 2, 1},
          .beta = {1. / 4, 1. / 4, 1. / 4, 1. / 4, 1. / 4},
          .alpha = {{},
                    {1. / 2},
                    {17. / 50, -1. / 25},
                    {371. / 1360, -137. / 2720, 15. / 544},
                    {25. / 24, -49. / 48, 125. / 16, -85. / 12}},
          .imaginary_limit = infinity,
          .real_limit = infinity,
          .is_symplectic = false,
          .keeps_energy_bounded = false,
          .note = "five solutions a step with one matrix; any step is stable, and modes that it "
                  "does not resolve are damped out"};
}

/// The order is that of signals that are no polynomials.
Method chebyshev() {
  return {.name = "chebyshev",
          .family = Method::Family::leaps,
          .order = 5,
          .stages = 4,
          .node = {0, 0.25, 0.5, 0.75}, // of signals: the points of signal_polynomial.hpp
          .beta = {0, 0, 0, 0},
          .alpha = {{}, {}, {}, {}},
          .imaginary_limit = infinity,
          .real_limit = 0,
          .is_symplectic = false,
          .keeps_energy_bounded = true,
          .note = "undamped linear models, exact for loads that are polynomials of degree 4 in a "
                  "step: leaps of many steps, each as many force evaluations as velocity_verlet "
                  "needs at its limit",
          .is_exponential = true};
}

} // namespace

Method generalized_alpha(double radius) {
  return {.name = "generalized_alpha",
          .family = Method::Family::generalized_alpha,
          .order = 2,
          .stages = 2,
          .node = {0, 1 / (1 + radius)},
          .beta = {0, 1},
          .alpha = {{}, {}},
          .imaginary_limit = infinity,
          .real_limit = infinity,
          .is_symplectic = false,
          .keeps_energy_bounded = radius == 1,
          .note = "one solution a step; any step is stable, and modes that it does not resolve "
                  "keep a part of their amplitude in each: 0.8, or R of generalized_alpha:R",
          .rate_share = (3 - radius) / (2 * (1 + radius))};
}

// T_j are Chebyshev polynomials, w0 = 1 + epsilon / s^2, w1 = T_s'(w0) / T_s''(w0),
// b_j = T_j''(w0) / T_j'(w0)^2, a_j = 1 - b_j T_j(w0). m and g stand for mu and gamma with a tilde:
//   Y_j = (1 - mu - nu) y + mu Y_{j-1} + nu Y_{j-2} + m h F_{j-1} + g h F_0
//   h F_0 = (Y_1 - y) / m_1
Method rkc2(int stages) {
  constexpr double epsilon = 2.0 / 13;
  const auto s = std::size_t(stages);
  const double w0 = 1 + epsilon / double(s * s);
  std::vector<double> t{1, w0}, d{0, 1},
      dd{0, 0}; // Chebyshev polynomials and their derivatives at w0
  for (std::size_t j = 2; j <= s; ++j) {
    t.push_back(2 * w0 * t[j - 1] - t[j - 2]);
    d.push_back(2 * t[j - 1] + 2 * w0 * d[j - 1] - d[j - 2]);
    dd.push_back(4 * d[j - 1] + 2 * w0 * dd[j - 1] - dd[j - 2]);
  }
  const double w1 = d[s] / dd[s];
  const auto b = [&](std::size_t j) {
    return dd[std::max<std::size_t>(j, 2)] /
           (d[std::max<std::size_t>(j, 2)] * d[std::max<std::size_t>(j, 2)]);
  };
  // R(-x) = 1 - b_s T_s(w0) + b_s T_s(w0 - w1 x) reaches 1 for even s and -1 for odd s, at the
  // argument -at_limit of T_s.
  const double at_limit = s % 2 == 0 ? w0 : std::cosh(std::acosh(2 / b(s) - t[s]) / double(s));
  Method method{.name = "rkc2",
                .family = Method::Family::runge_kutta,
                .order = 2,
                .stages = stages,
                .node = {},
                .beta = {b(1) * w1},
                .alpha = {{0}},
                .imaginary_limit = 0,
                .real_limit = (w0 + at_limit) / w1,
                .is_symplectic = false,
                .keeps_energy_bounded = false,
                .note = "Runge-Kutta-Chebyshev for strong damping: as many force evaluations a "
                        "step as that needs; its "
                        "limit grows with "
                        "their square"};
  for (std::size_t j = 2; j <= s; ++j) {
    const double mu = 2 * b(j) * w0 / b(j - 1), nu = -b(j) / b(j - 2),
                 mu_tilde = 2 * b(j) * w1 / b(j - 1);
    const double gamma_tilde = -(1 - b(j - 1) * t[j - 1]) * mu_tilde;
    std::vector<double> alpha(j);
    alpha[1] = gamma_tilde / method.beta[0];
    alpha[j - 1] += mu;
    if (j > 2) alpha[j - 2] += nu;
    method.beta.push_back(mu_tilde);
    method.alpha.push_back(std::move(alpha));
  }
  method.node = nodes_of(method.alpha, method.beta);
  return method;
}

const std::vector<Method>& methods() {
  static const std::vector<Method> all = [] {
    std::vector<Method> list = {rk4(), velocity_verlet(), smoothed_verlet(), midpoint(),
                                symplectic_euler()};
    for (Method& method : butcher_methods()) list.push_back(std::move(method));
    list.push_back(rkc2(5));
    return list;
  }();
  return all;
}

const std::vector<Method>& implicit_methods() {
  static const std::vector<Method> all = {implicit_midpoint(), newmark(), generalized_alpha(0.8),
                                          sdirk4()};
  return all;
}

const std::vector<Method>& exponential_methods() {
  static const std::vector<Method> all = {chebyshev(), faber({}, 0)};
  return all;
}

double implicit_share(const Method& method) {
  switch (method.family) {
  case Method::Family::diagonally_implicit:
    return method.beta.back();
  case Method::Family::generalized_alpha:
    return method.node[1] * method.rate_weight() / method.rate_share;
  default:
    return 0.5;
  }
}

} // namespace dss
