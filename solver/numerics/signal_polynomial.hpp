#pragma once
/// Signals within a step as polynomials through five of their values.
#include <array>
#include <cstddef>

namespace dss {

/// Parts of a step. Signals are given at its start, at the end of each part, and so at five points.
inline constexpr int signal_parts = 4;
inline constexpr int signal_points = signal_parts + 1;

/// polynomials[p][j]: coefficient of the power j of the time (0 to 1 over a step) in the polynomial
/// that is 1 at the point p and 0 at the others.
using PointPolynomials = std::array<std::array<double, signal_points>, signal_points>;
constexpr PointPolynomials point_polynomials() {
  PointPolynomials all{};
  for (int p = 0; p < signal_points; ++p) {
    auto& polynomial = all[std::size_t(p)];
    polynomial[0] = 1;
    for (int other = 0; other < signal_points; ++other) {
      if (other == p) continue;
      // times (signal_parts t - other) / (p - other)
      for (std::size_t j = signal_points - 1; j > 0; --j)
        polynomial[j] = (signal_parts * polynomial[j - 1] - other * polynomial[j]) / (p - other);
      polynomial[0] *= -double(other) / (p - other);
    }
  }
  return all;
}

} // namespace dss
