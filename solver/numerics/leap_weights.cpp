#include "solver/numerics/leap_weights.hpp"

#include "solver/numerics/bessel.hpp"
#include "solver/numerics/signal_polynomial.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dss {
namespace {

/// Weights below it change nothing.
constexpr double negligible_weight = 1e-16;

/// Gauss's rule with eight points on [-1, 1]: M. Abramowitz, I. A. Stegun, table 25.4.
constexpr std::array gauss_points{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                  0.9602898564975363};
constexpr std::array gauss_weights{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                   0.1012285362903763};
/// Largest phase of a part of a step over which the rule is exact to rounding.
constexpr double phase_of_part = 2;

/// Slopes at the time `at` (0 to 1 over a step) of the polynomials that are 1 at one of the points.
std::array<double, signal_points> point_slopes(double at) {
  constexpr PointPolynomials polynomials = point_polynomials();
  std::array<double, signal_points> slopes{};
  for (std::size_t p = 0; p < slopes.size(); ++p)
    for (std::size_t j = signal_points - 1; j > 0; --j)
      slopes[p] = slopes[p] * at + double(j) * polynomials[p][j];
  return slopes;
}

/// From weights of T_n to weights of V_n.
void change_basis(std::vector<double>& weights) {
  weights.front() *= 2; // T_0 = (V_0 + V_0) / 2
  for (std::size_t n = 0; n < weights.size(); ++n)
    weights[n] = (weights[n] + (n + 1 < weights.size() ? weights[n + 1] : 0)) / 2;
}

void change_basis(StateWeights& weights) {
  change_basis(weights.displacement);
  change_basis(weights.velocity);
}

} // namespace

LeapWeights::LeapWeights(double omega, double step, long steps)
    : omega_(omega), step_(step), steps_(steps) {
  const double z = omega * step * double(steps);
  orders_ = bessel_orders(z);
  std::vector<double> j(orders_);
  bessel_j(z, j);
  std::size_t last = orders_ - 1;
  while (last > 0 && std::abs(j[last]) < negligible_weight) --last;
  states_ = std::min(last / 2 + 2, (orders_ - 1) / 2);
}

/// J_0 and 2 J_2n, and their derivatives -J_1 and J_(2n-1) - J_(2n+1), at z.
StateWeights LeapWeights::sums(double z) const {
  std::vector<double> j(std::max(orders_, 2 * states_ + 2));
  bessel_j(z, std::span(j).first(bessel_orders(z))); // the others are zero
  StateWeights weights{std::vector<double>(states_), std::vector<double>(states_)};
  weights.displacement[0] = j[0];
  weights.velocity[0] = -omega_ * j[1];
  for (std::size_t n = 1; n < states_; ++n) {
    weights.displacement[n] = 2 * j[2 * n];
    weights.velocity[n] = omega_ * (j[2 * n - 1] - j[2 * n + 1]);
  }
  return weights;
}

StateWeights LeapWeights::of_displacement() const {
  StateWeights weights = sums(omega_ * step_ * double(steps_));
  change_basis(weights);
  return weights;
}

// int_0^z J_2n = 2 (J_(2n+1) + J_(2n+3) + ...).
StateWeights LeapWeights::of_velocity() const {
  const double z = omega_ * step_ * double(steps_);
  std::vector<double> j(std::max(orders_, 2 * states_ + 2));
  bessel_j(z, j);
  StateWeights weights{std::vector<double>(states_), sums(z).displacement};
  for (double& weight : weights.velocity) weight *= omega_;
  double sum = 0;
  for (std::size_t odd = (j.size() - 2) | 1; odd < j.size(); odd -= 2) {
    sum += 2 * j[odd];
    if (const std::size_t n = odd / 2; n < states_)
      weights.displacement[n] = n == 0 ? sum : 2 * sum;
  }
  change_basis(weights);
  return weights;
}

std::vector<StateWeights> LeapWeights::of_signals(std::span<const double> rows, std::size_t width,
                                                  std::span<const std::size_t> chosen) const {
  const StateWeights none{std::vector<double>(states_), std::vector<double>(states_)};
  std::vector<StateWeights> all(chosen.size(), none);
  const int parts = std::max(1, int(std::ceil(omega_ * step_ / phase_of_part)));
  const auto add_point = [&](long k, double at, double weight) {
    const auto slopes = point_slopes(at);
    const double* const of_step = &rows[std::size_t(k) * signal_parts * width];
    std::vector<double> rates(chosen.size());
    for (std::size_t c = 0; c < chosen.size(); ++c)
      for (std::size_t p = 1; p < slopes.size(); ++p)
        rates[c] += weight * slopes[p] * (of_step[p * width + chosen[c]] - of_step[chosen[c]]);
    if (std::ranges::all_of(rates, [](double rate) { return rate == 0; })) return;
    const StateWeights here = sums(omega_ * step_ * (double(steps_ - k) - at));
    for (std::size_t c = 0; c < chosen.size(); ++c)
      for (std::size_t n = 0; n < states_; ++n) {
        all[c].displacement[n] += rates[c] * here.displacement[n];
        all[c].velocity[n] += rates[c] * here.velocity[n];
      }
  };
  for (long k = 0; k < steps_; ++k)
    for (int part = 0; part < parts; ++part)
      for (std::size_t g = 0; g < gauss_points.size(); ++g)
        for (const int side : {-1, 1})
          add_point(k, (part + (1 + side * gauss_points[g]) / 2) / parts,
                    gauss_weights[g] / (2 * parts));
  for (StateWeights& weights : all) change_basis(weights);
  return all;
}

} // namespace dss
