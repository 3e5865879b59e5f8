#include "solver/statics/factors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <random>

namespace dss {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Matrix = Factors::Matrix;

/// Lower half of the matrix of a grid of n^3 points that are linked to their neighbours.
Matrix grid(Index n, double diagonal) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto place = [&](Index x, Index y, Index z) { return int((z * n + y) * n + x); };
  for (Index z = 0; z < n; ++z)
    for (Index y = 0; y < n; ++y)
      for (Index x = 0; x < n; ++x) {
        entries.emplace_back(place(x, y, z), place(x, y, z), diagonal);
        if (x + 1 < n) entries.emplace_back(place(x + 1, y, z), place(x, y, z), -1);
        if (y + 1 < n) entries.emplace_back(place(x, y + 1, z), place(x, y, z), -1);
        if (z + 1 < n) entries.emplace_back(place(x, y, z + 1), place(x, y, z), -1);
      }
  Matrix matrix(n * n * n, n * n * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

MatrixXd right_hand_sides(Index rows, Index columns) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

double residual(const Factors& factors, const Matrix& lower) {
  const MatrixXd b = right_hand_sides(lower.rows(), 3);
  return (lower.selfadjointView<Eigen::Lower>() * factors.solve(b) - b).norm() / b.norm();
}

// Sizes with and without blocks of columns.
TEST(Factors, solve_definite_and_indefinite_equations) {
  for (const Index n : {2, 5, 17})
    for (const double diagonal : {6.5, 0.3}) {
      Factors factors;
      const Matrix matrix = grid(n, diagonal);
      factors.compute(matrix);
      ASSERT_TRUE(factors.are_complete());
      EXPECT_LT(residual(factors, matrix), diagonal > 6 ? 1e-14 : 1e-9) << n << ' ' << diagonal;
      EXPECT_EQ(factors.zero_pivot(matrix), std::nullopt);
    }
}

TEST(Factors, count_the_negative_eigenvalues) {
  for (const Index n : {3, 9})
    for (const double diagonal : {6.5, 4.4, 0.3, -7.0}) {
      Factors factors;
      factors.compute(grid(n, diagonal));
      const MatrixXd dense = MatrixXd(grid(n, diagonal)).selfadjointView<Eigen::Lower>();
      const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(dense).eigenvalues();
      EXPECT_EQ(factors.negative_pivots(), (values.array() < 0).count()) << n << ' ' << diagonal;
    }
}

TEST(Factors, name_an_unknown_that_takes_no_force) {
  for (const Index n : {3, 15})
    for (const bool is_exact : {true, false}) {
      Matrix matrix = grid(n, 6.5);
      const Index free = n * n; // linked to no other, or to one that moves with it
      matrix.prune([&](Index r, Index c, double) {
        return is_exact ? r != free && c != free
                        : (r != free && c != free && r != free + 1 && c != free + 1);
      });
      if (is_exact) {
        matrix.coeffRef(free, free) = 0;
      } else {
        matrix.coeffRef(free, free) = matrix.coeffRef(free + 1, free + 1) = 0.1;
        matrix.coeffRef(free + 1, free) = -0.1;
      }
      matrix.makeCompressed();
      Factors factors;
      factors.compute(matrix);
      const auto zero = factors.zero_pivot(matrix);
      ASSERT_TRUE(zero) << n << is_exact;
      EXPECT_TRUE(*zero == free || (!is_exact && *zero == free + 1)) << *zero;
    }
}

TEST(Factors, take_matrices_in_turn_with_entries_in_the_same_and_in_other_places) {
  Factors factors;
  for (const double diagonal : {6.5, 0.3, 7.0, -7.0})
    for (const Index n : {15, 15, 4}) {
      const Matrix matrix = grid(n, diagonal);
      factors.compute(matrix);
      ASSERT_TRUE(factors.are_complete());
      EXPECT_LT(residual(factors, matrix), 1e-9) << n << ' ' << diagonal;
    }
}

TEST(Factors, tell_their_work_and_memory_before_they_are_made) {
  Factors small, large;
  small.analyse(grid(6, 6.5));
  large.analyse(grid(18, 6.5));
  // Of n^3 points nested dissection needs some n^6 multiplications and n^4 entries.
  EXPECT_GT(large.work(), 300 * small.work());
  EXPECT_GT(large.bytes(), 40 * small.bytes());
  EXPECT_LT(large.bytes(), 18. * 18 * 18 * 18 * 18 * 18 * 8);
}

} // namespace
} // namespace dss
