#include "solver/numerics/butcher_tables.hpp"

#include <cmath>
#include <utility>

namespace dss {
namespace {

using Rows = std::vector<std::vector<double>>;

/// Increment form of a Butcher table whose row s gives Y_{s+1} - y = h sum_j rows[s][j] k_j; the
/// last row gives y_{n+1} - y. k_m is taken from Y_{m+1}, starting with the last m, so rows[s][s]
/// must not be 0.
void set_butcher(const Rows& rows, Method& method) {
  for (std::size_t s = 0; s < rows.size(); ++s) {
    std::vector<long double> rest(rows[s].begin(), rows[s].end());
    std::vector<double> alpha(s + 1);
    for (std::size_t m = s; m > 0; --m) {
      const long double of_m = rest[m - 1] / rows[m - 1][m - 1];
      for (std::size_t j = 0; j < m; ++j) rest[j] -= of_m * rows[m - 1][j];
      alpha[m] = double(of_m);
    }
    method.beta.push_back(rows[s][s]);
    method.alpha.push_back(std::move(alpha));
  }
  method.node = nodes_of(method.alpha, method.beta);
}

/// An explicit method without an error stage.
Method explicit_method(std::string_view name, int order, const Rows& rows, double imaginary_limit,
                       double real_limit, std::string_view note) {
  Method method{.name = name,
                .family = Method::Family::runge_kutta,
                .order = order,
                .stages = int(rows.size()),
                .node = {},
                .beta = {},
                .alpha = {},
                .imaginary_limit = imaginary_limit,
                .real_limit = real_limit,
                .is_symplectic = false,
                .keeps_energy_bounded = false,
                .note = note};
  set_butcher(rows, method);
  return method;
}

/// Method of Dormand and Prince, order 5 (J. Comput. Appl. Math. 6 (1980) 19-26; Hairer, Norsett,
/// Wanner I, table II.5.2). The last row is the step.
const Rows& dopri5_rows() {
  static const Rows rows = {{1. / 5},
                            {3. / 40, 9. / 40},
                            {44. / 45, -56. / 15, 32. / 9},
                            {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
                            {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
                            {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};
  return rows;
}

Method dopri5() {
  return explicit_method("dopri5", 5, dopri5_rows(), 0.9971890106932, 3.306567892634,
                         "six force evaluations a step");
}

/// Order 8 (G. J. Cooper, J. H. Verner, SIAM J. Numer. Anal. 9 (1972) 389-405). Newer methods of
/// order 8 have smaller errors, but numbers near 10^4 in increment form (README.md).
Method verner8() {
  const double s = std::sqrt(21);
  return explicit_method(
      "verner8", 8,
      {{1. / 2},
       {1. / 4, 1. / 4},
       {1. / 7, (-7 - 3 * s) / 98, (21 + 5 * s) / 49},
       {(11 + s) / 84, 0, (18 + 4 * s) / 63, (21 - s) / 252},
       {(5 + s) / 48, 0, (9 + s) / 36, (-231 + 14 * s) / 360, (63 - 7 * s) / 80},
       {(10 - s) / 42, 0, (-432 + 92 * s) / 315, (633 - 145 * s) / 90, (-504 + 115 * s) / 70,
        (63 - 13 * s) / 35},
       {1. / 14, 0, 0, 0, (14 - 3 * s) / 126, (13 - 3 * s) / 63, 1. / 9},
       {1. / 32, 0, 0, 0, (91 - 21 * s) / 576, 11. / 72, (-385 - 75 * s) / 1152,
        (63 + 13 * s) / 128},
       {1. / 14, 0, 0, 0, 1. / 9, (-733 - 147 * s) / 2205, (515 + 111 * s) / 504,
        (-51 - 11 * s) / 56, (132 + 28 * s) / 245},
       {0, 0, 0, 0, (-42 + 7 * s) / 18, (-18 + 28 * s) / 45, (-273 - 53 * s) / 72,
        (301 + 53 * s) / 72, (28 - 28 * s) / 45, (49 - 7 * s) / 18},
       {1. / 20, 0, 0, 0, 0, 0, 0, 49. / 180, 16. / 45, 49. / 180, 1. / 20}},
      3.0017836909, 3.7153764017, "eleven force evaluations a step, for small errors");
}

} // namespace

std::vector<double> nodes_of(const std::vector<std::vector<double>>& alpha,
                             const std::vector<double>& beta) {
  std::vector<double> node{0};
  for (std::size_t s = 0; s + 1 < beta.size(); ++s) {
    double sum = beta[s];
    for (std::size_t m = 1; m <= s; ++m) sum += alpha[s][m] * node[m];
    node.push_back(sum);
  }
  return node;
}

// The seventh stage evaluates f at y_{n+1}. Its weights are those of table II.5.2 minus those of
// the fourth-order method there.
const Method& dopri5_adaptive() {
  static const Method adaptive = [] {
    Method method = dopri5();
    Rows rows = dopri5_rows();
    rows.push_back(
        {71. / 57600, 0, -71. / 16695, 71. / 1920, -17253. / 339200, 22. / 525, -1. / 40});
    method.stages = int(rows.size());
    method.has_error_stage = true;
    method.note = "seven force evaluations a step that is tried";
    method.beta.clear(), method.alpha.clear();
    set_butcher(rows, method);
    return method;
  }();
  return adaptive;
}

std::vector<Method> butcher_methods() { return {dopri5(), verner8()}; }

} // namespace dss
