#include "experiments/studies/failures/elliptic.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dss {
namespace {

constexpr double moduli[] = {0, 0.1, 0.5, 0.9, 0.999};
constexpr double arguments[] = {-7.3, -0.4, 0, 0.2, 1, 2.5, 11};

TEST(Jacobi, satisfies_its_two_identities) {
  for (const double k : moduli)
    for (const double u : arguments) {
      const Jacobi j = jacobi(u, k);
      EXPECT_NEAR(j.sn * j.sn + j.cn * j.cn, 1, 1e-14);
      EXPECT_NEAR(j.dn * j.dn + k * k * j.sn * j.sn, 1, 1e-14);
    }
}

TEST(Jacobi, is_the_inverse_of_the_standard_librarys_integral) {
  for (const double k : moduli)
    for (const double amplitude : {-1.2, 0.3, 1.0, 1.5}) {
      const Jacobi j = jacobi(std::ellint_1(k, amplitude), k);
      EXPECT_NEAR(j.sn, std::sin(amplitude), 1e-13) << k;
      EXPECT_NEAR(j.cn, std::cos(amplitude), 1e-13) << k;
    }
}

TEST(Jacobi, repeats_after_four_quarter_periods) {
  for (const double k : moduli) {
    const double quarter = std::comp_ellint_1(k);
    for (const double u : arguments) {
      const Jacobi here = jacobi(u, k), there = jacobi(u + 4 * quarter, k),
                   half = jacobi(u + 2 * quarter, k);
      EXPECT_NEAR(there.sn, here.sn, 1e-12);
      EXPECT_NEAR(there.cn, here.cn, 1e-12);
      EXPECT_NEAR(half.cn, -here.cn, 1e-12);
      EXPECT_NEAR(half.dn, here.dn, 1e-12);
    }
  }
}

TEST(Jacobi, obeys_the_addition_theorem) {
  for (const double k : moduli) {
    const Jacobi a = jacobi(0.7, k), b = jacobi(0.4, k), sum = jacobi(1.1, k);
    const double below = 1 - k * k * a.sn * a.sn * b.sn * b.sn;
    EXPECT_NEAR(sum.sn, (a.sn * b.cn * b.dn + b.sn * a.cn * a.dn) / below, 1e-14);
    EXPECT_NEAR(sum.cn, (a.cn * b.cn - a.sn * b.sn * a.dn * b.dn) / below, 1e-14);
  }
}

} // namespace
} // namespace dss
