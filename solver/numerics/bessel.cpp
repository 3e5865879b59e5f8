#include "solver/numerics/bessel.hpp"

#include <algorithm>
#include <cmath>

namespace dss {

// J_n(z) falls like exp(-(2/3) (2/z)^(1/2) (n - z)^(3/2)) beyond n = z, and like (z/2)^n / n! for
// small z.
std::size_t bessel_orders(double z) { return std::size_t(std::ceil(z + 12 * std::cbrt(z) + 16)); }

void bessel_j(double z, std::span<double> values) {
  std::ranges::fill(values, 0);
  if (z == 0) {
    values[0] = 1;
    return;
  }
  // Numbers grow on the way down; they are scaled before they overflow.
  constexpr double start = 1e-300, large = 1e250;
  double above = 0, here = start, sum = 0;
  for (std::size_t n = values.size() - 1;; --n) {
    values[n] = here;
    if (n % 2 == 0) sum += n == 0 ? here : 2 * here;
    if (n == 0) break;
    const double below = 2 * double(n) / z * here - above;
    above = here;
    here = below;
    if (std::abs(here) > large) {
      for (double* scaled : {&above, &here, &sum}) *scaled /= large;
      for (std::size_t m = n; m < values.size(); ++m) values[m] /= large;
    }
  }
  for (double& value : values) value /= sum;
}

} // namespace dss
