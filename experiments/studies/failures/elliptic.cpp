#include "experiments/studies/failures/elliptic.hpp"

#include <cmath>
#include <vector>

namespace dss {

Jacobi jacobi(double u, double k) {
  struct Mean {
    double a, c;
  };
  std::vector<Mean> means = {{1, k}};
  for (double a = 1, b = std::sqrt((1 - k) * (1 + k));
       means.back().c > 1e-17 * means.back().a && means.size() < 32;) {
    const double next = (a + b) / 2, half_difference = (a - b) / 2;
    b = std::sqrt(a * b);
    a = next;
    means.push_back({a, half_difference});
  }
  double amplitude = std::ldexp(means.back().a * u, int(means.size()) - 1);
  for (std::size_t n = means.size() - 1; n > 0; --n)
    amplitude = (amplitude + std::asin(means[n].c / means[n].a * std::sin(amplitude))) / 2;
  const double sn = std::sin(amplitude);
  return {sn, std::cos(amplitude), std::sqrt(1 - k * k * sn * sn)};
}

} // namespace dss
