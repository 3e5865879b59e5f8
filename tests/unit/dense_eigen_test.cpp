#include "solver/numerics/dense_eigen.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dss {
namespace {

TEST(DenseEigen, of_known_matrices) {
  Eigen::MatrixXd oscillator(2, 2); // x'' = -4 x: eigenvalues 2i and -2i
  oscillator << 0, 1, -4, 0;
  EXPECT_NEAR(spectral_radius(oscillator), 2, 1e-15);
  for (const auto value : eigenvalues(oscillator)) EXPECT_NEAR(value.real(), 0, 1e-15);

  Eigen::MatrixXd symmetric(2, 2); // 1 for (1, -1), 3 for (1, 1)
  symmetric << 2, 1, 1, 2;
  const SymmetricEigen solved(symmetric);
  EXPECT_NEAR(solved.values[0], 1, 1e-15);
  EXPECT_NEAR(solved.values[1], 3, 1e-15);
  EXPECT_NEAR(std::abs(solved.vectors.col(1).sum()), std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(solved.vectors.col(0).sum(), 0, 1e-15);

  const SymmetricEigen chain(Eigen::VectorXd::Constant(3, 2), Eigen::VectorXd::Constant(2, -1));
  for (int n = 0; n < 3; ++n)
    EXPECT_NEAR(chain.values[n], 2 - 2 * std::cos((n + 1) * M_PI / 4), 1e-14);
}

} // namespace
} // namespace dss
