/// Bessel functions, and exact leaps of one oscillator.
#include "solver/numerics/bessel.hpp"
#include "solver/numerics/leap_weights.hpp"
#include "solver/numerics/signal_polynomial.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace dss {
namespace {

TEST(Bessel, functions_have_published_values) {
  // M. Abramowitz, I. A. Stegun, tables 9.1 and 9.4.
  const struct {
    double z;
    std::size_t order;
    double value;
  } published[] = {{1, 0, 0.765197686557967},    {1, 1, 0.440050585744934},
                   {10, 0, -0.245935764451348},  {10, 1, 0.0434727461688614},
                   {10, 10, 0.2074861066333589}, {2, 10, 2.515386283e-7},
                   {50, 20, -0.1167043528},      {100, 50, -3.869833973e-2},
                   {1, 20, 3.873503009e-25},     {0, 0, 1}};
  for (const auto& [z, order, value] : published) {
    std::vector<double> j(std::max(bessel_orders(z), order + 2));
    bessel_j(z, j);
    EXPECT_NEAR(j[order], value, 1e-9 * std::abs(value) + 1e-30) << order << ' ' << z;
  }
}

/// J_0^2 + 2 J_1^2 + 2 J_2^2 + ... = 1, and three terms are related.
TEST(Bessel, functions_obey_their_identities_for_small_and_large_arguments) {
  for (const double z : {1e-9, 1e-3, 0.7, 12.0, 300.0, 2e4}) {
    std::vector<double> j(bessel_orders(z) + 5);
    bessel_j(z, j);
    double squares = -j[0] * j[0];
    for (const double value : j) squares += 2 * value * value;
    EXPECT_NEAR(squares, 1, 1e-12) << z;
    for (std::size_t n = 1; n < 20; ++n)
      EXPECT_NEAR(j[n - 1] + j[n + 1], 2 * double(n) / z * j[n], 1e-13 * (1 + double(n) / z)) << z;
    EXPECT_LT(std::abs(j[bessel_orders(z) - 1]), 1e-18) << z;
  }
}

/// x'' = -square x + g(t), t = 0 at the start.
struct Oscillator {
  double square, x, v;
};

/// Adds the weighted states of a run by symplectic Euler at its limit.
void add_run(Oscillator start, double load, double omega, const StateWeights& weights,
             Oscillator& sum) {
  const double h = 2 / omega;
  for (std::size_t n = 0; n < weights.displacement.size(); ++n) {
    if (n > 0) start.v += h * (load - start.square * start.x), start.x += h * start.v;
    sum.x += weights.displacement[n] * start.x;
    sum.v += weights.velocity[n] * start.x;
  }
}

/// The signal 1 + t, and the exact solution with it.
Oscillator exact(const Oscillator& at_start, double t) {
  const auto& [square, x, v] = at_start;
  if (square == 0) return {0, x + v * t + t * t / 2 + t * t * t / 6, v + t + t * t / 2};
  const double w = std::sqrt(square), c = std::cos(w * t), s = std::sin(w * t);
  const double x0 = x - 1 / square, v0 = v - 1 / square; // apart from (1 + t) / square
  return {square, x0 * c + v0 / w * s + (1 + t) / square, v0 * c - w * x0 * s + 1 / square};
}

TEST(LeapWeights, give_the_exact_motion_of_any_frequency_up_to_the_bound) {
  constexpr double omega = 3;
  for (const double length : {1e-3, 0.2, 4.0, 60.0})
    for (const long steps : {1L, 9L})
      for (const double square : {0.0, 0.01, 0.5, 4.0, 8.99, 9.0}) {
        const double step = length / double(steps);
        const Oscillator start{square, 0.7, -1.3};
        const LeapWeights weights(omega, step, steps);
        std::vector<double> rows; // two signals, of which the second is the load's
        for (long row = 0; row <= signal_parts * steps; ++row)
          for (const double value : {7.0, 1 + double(row) * step / signal_parts})
            rows.push_back(value);
        Oscillator sum{square, 0, 0};
        add_run({square, start.x, 0}, 1, omega, weights.of_displacement(), sum);
        add_run({square, start.v / omega, 0}, 0, omega, weights.of_velocity(), sum);
        const std::size_t chosen[] = {1};
        add_run({square, 0, 0}, 1, omega, weights.of_signals(rows, 2, chosen).front(), sum);
        const Oscillator expected = exact(start, length);
        const double scale = std::max({1.0, std::abs(expected.x), std::abs(expected.v)});
        EXPECT_NEAR(sum.x, expected.x, 2e-12 * scale) << length << ' ' << steps << ' ' << square;
        EXPECT_NEAR(sum.v, expected.v, 2e-12 * scale) << length << ' ' << steps << ' ' << square;
      }
}

TEST(LeapWeights, have_few_states_beyond_those_of_the_time) {
  for (const double z : {40.0, 400.0, 4000.0}) {
    const double states = double(LeapWeights(1, z, 1).states());
    EXPECT_GE(states, z / 2);
    EXPECT_LE(states, z / 2 + 5 * std::cbrt(z) + 6) << z;
  }
}

/// A kink where a step ends is no error; a polynomial of degree 4 in each step is exact.
TEST(LeapWeights, follow_signals_with_kinks_where_steps_end) {
  constexpr double omega = 2, step = 1.5;
  const auto state_at_end = [&](long cuts) {
    const long steps = 2 * cuts;
    std::vector<double> rows;
    for (long row = 0; row <= signal_parts * steps; ++row) {
      const double t = double(row) * step / double(cuts * signal_parts);
      rows.push_back(t < step ? t * t * t * t : std::pow(step, 4) - (t - step));
    }
    const LeapWeights weights(omega, step / double(cuts), steps);
    Oscillator sum{2.5, 0, 0};
    const std::size_t chosen[] = {0};
    add_run({2.5, 0, 0}, 1, omega, weights.of_signals(rows, 1, chosen).front(), sum);
    return std::array{sum.x, sum.v};
  };
  const auto coarse = state_at_end(1), fine = state_at_end(16);
  EXPECT_NEAR(coarse[0], fine[0], 1e-12);
  EXPECT_NEAR(coarse[1], fine[1], 1e-12);
}

} // namespace
} // namespace dss
