#include "experiments/measure/richardson.hpp"

#include <cmath>
#include <limits>

namespace dss {

Richardson richardson(const std::vector<double>& h, const std::vector<double>& f) {
  const double wanted = (f[0] - f[1]) / (f[1] - f[2]);
  const auto ratio = [&](double p) {
    return (std::pow(h[0], p) - std::pow(h[1], p)) / (std::pow(h[1], p) - std::pow(h[2], p));
  };
  double low = 0.1, high = 10; // the ratio grows with p
  if (!(wanted >= ratio(low) && wanted <= ratio(high))) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none};
  }
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (low + high) / 2;
    (ratio(middle) < wanted ? low : high) = middle;
  }
  const double c = (f[1] - f[2]) / (std::pow(h[1], low) - std::pow(h[2], low));
  return {low, f[2] - c * std::pow(h[2], low)};
}

} // namespace dss
