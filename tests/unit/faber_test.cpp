/// The table of faber against exponentials.
#include "solver/numerics/faber.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace dss {
namespace {

using Complex = std::complex<double>;

/// A step of y' = root y + load(t), y(0) = y, with h = 1: loads by the weights of the stages.
template <class Load>
Complex step(const Method& method, Complex root, Complex y, Load&& load) {
  std::vector<Complex> stages{y};
  for (std::size_t s = 0; s < std::size_t(method.stages); ++s) {
    double signal = 0;
    for (int p = 0; p < signal_points; ++p)
      signal += method.signal_weights[s][std::size_t(p)] * load(double(p) / signal_parts);
    Complex next = y + method.beta[s] * (root * stages[s] + signal);
    for (std::size_t m = 1; m <= s; ++m) next += method.alpha[s][m] * (stages[m] - y);
    stages.push_back(next);
  }
  return stages.back();
}

/// Calls visit(spectrum, frequency, rate) for modes that the bounds of a spectrum allow.
template <class Visit>
void for_each_mode(double omega, Visit&& visit) {
  for (const double ratio : {0.0, 0.02, 0.5, 0.9, 1.9})
    for (const double least : {0.0, 0.7, 1.0}) { // share of the damping that every mode has
      const Spectrum spectrum{omega, ratio * omega, least * ratio / omega, 0};
      for (const double part : {0.0, 0.1, 0.5, 0.9, 1.0})
        for (const double more : {0.0, 0.5, 1.0}) {
          const double w = part * omega, floor = spectrum.least_damping * w * w;
          visit(spectrum, w, floor + more * (spectrum.damping - floor));
        }
    }
}

TEST(Faber, is_the_exponential_of_every_mode_within_the_bounds) {
  for (const double omega : {0.3, 3.0, 20.0})
    for_each_mode(omega, [&](const Spectrum& spectrum, double w, double rate) {
      const Method method = faber(spectrum, 1);
      ASSERT_GT(method.stages, 0);
      const Complex part = std::sqrt(Complex(rate * rate / 4 - w * w));
      for (const Complex root : {-rate / 2 + part, -rate / 2 - part})
        EXPECT_LT(std::abs(step(method, root, 1, [](double) { return 0.0; }) - std::exp(root)),
                  1e-12)
            << omega << ' ' << spectrum.damping << ' ' << root;
    });
}

/// y' = root y + t^power from rest: y(1) is the integral of e^(root (1 - s)) s^power.
Complex exact_integral(Complex root, int power) {
  if (root == 0.0) return 1.0 / (power + 1);
  Complex integral = (std::exp(root) - 1.0) / root;
  for (int n = 1; n <= power; ++n) integral = (double(n) * integral - 1.0) / root;
  return integral;
}

TEST(Faber, integrates_loads_that_are_polynomials_of_degree_four_and_no_others) {
  const auto error = [](Complex root, int power, double omega = 20) {
    const Method method = faber({omega, omega / 5, 0, 0}, 1);
    return std::abs(step(method, root, 0, [&](double t) { return std::pow(t, power); }) -
                    exact_integral(root, power));
  };
  for (const Complex root : {Complex(-0.5, 3), Complex(-2, 19), Complex(-1, 0)})
    for (const int power : {0, 1, 2, 3, 4}) EXPECT_LT(error(root, power), 1e-12) << root;
  EXPECT_GT(error({-0.5, 3}, 7), 1e-5);
  // In short steps of slow motions, and of what no spring holds.
  for (const double omega : {0.0, 1e-9, 0.01})
    for (const int power : {0, 1, 2, 3, 4}) EXPECT_LT(error(0, power, omega), 1e-12);
}

TEST(Faber, keeps_a_constant_to_rounding_and_has_tame_coefficients) {
  for (const double dt : {0.1, 1.0, 10.0, 100.0}) {
    const Method method = faber({2, 0.5, 0.2, 0}, dt);
    EXPECT_NEAR(std::abs(step(method, 0, 1, [](double) { return 0.0; })), 1, 1e-15);
    for (const auto& row : method.alpha)
      for (const double number : row) EXPECT_LT(std::abs(number), 2);
    for (const double node : method.node) EXPECT_TRUE(node > -0.2 && node < 1.3) << node;
  }
}

TEST(Faber, has_no_stages_where_too_many_or_too_much_rounding_would_be_needed) {
  EXPECT_EQ(faber({1, 0, 0, 0}, 1000).stages, 0);
  EXPECT_EQ(faber({1, 0.9, 0, 0}, 100).stages, 0); // terms of e^18 would cancel
  EXPECT_GT(faber({1, 0.9, 0.9, 0}, 100).stages, 0);
  EXPECT_EQ(faber({1, 0, 0, 0}, 0).stages, 0);
}

} // namespace
} // namespace dss
