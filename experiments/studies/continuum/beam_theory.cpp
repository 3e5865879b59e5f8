#include "experiments/studies/continuum/beam_theory.hpp"
#include "solver/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

/// Huang's frequency equation, divided by cosh so that it stays of order 1. b = omega L^2
/// sqrt(m/EI); r2 and s2 are the dimensionless rotary inertia and shear flexibility.
double frequency_equation(double b, double r2, double s2) {
  const double mean = (r2 + s2) / 2, root = std::sqrt((r2 - s2) * (r2 - s2) / 4 + 1 / (b * b));
  const double a = b * std::sqrt(root - mean), c = b * std::sqrt(root + mean);
  return 2 / std::cosh(a) + (b * b * (r2 - s2) * (r2 - s2) + 2) * std::cos(c) -
         b * (r2 + s2) / std::sqrt(1 - b * b * r2 * s2) * std::tanh(a) * std::sin(c);
}

} // namespace

std::vector<double> cantilever_frequencies(const TimoshenkoBeam& beam, int count) {
  const double L2 = beam.length * beam.length;
  const double r2 = beam.rotary / (beam.mass * L2), s2 = beam.bending / (beam.shear * L2);
  const double to_omega = std::sqrt(beam.bending / beam.mass) / L2,
               cut_off = 1 / std::sqrt(r2 * s2);
  // Smaller than the distance of roots: the first root of an Euler-Bernoulli beam is 3.516, and the
  // others are further apart.
  constexpr double increment = 0.02;
  std::vector<double> frequencies;
  for (double low = increment; int(frequencies.size()) < count; low += increment) {
    if (low + increment >= cut_off)
      throw InputError(fmt::format(
          "Timoshenko's cantilever has {} frequencies below its cut-off, {:.4g} rad/s; {} were "
          "asked for",
          frequencies.size(), cut_off * to_omega, count));
    double a = low, b = low + increment;
    const bool is_positive = frequency_equation(a, r2, s2) > 0;
    if (is_positive == (frequency_equation(b, r2, s2) > 0)) continue;
    while (b - a > 1e-14 * b) {
      const double middle = (a + b) / 2;
      ((frequency_equation(middle, r2, s2) > 0) == is_positive ? a : b) = middle;
    }
    frequencies.push_back((a + b) / 2 * to_omega);
  }
  return frequencies;
}

} // namespace dss
