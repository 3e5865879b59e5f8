#pragma once
#include <Eigen/Core>

namespace dss {

/// Eigenvalues of a symmetric matrix, ascending, and its orthonormal eigenvectors in the same
/// order, one a column. One function serves matrices of every size, because Eigen's solver takes
/// seconds to compile for each type.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;

  /// Reads the lower triangle.
  explicit SymmetricEigen(const Eigen::MatrixXd& matrix);
  /// For a tridiagonal matrix: n entries on the diagonal, n - 1 beside it.
  SymmetricEigen(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& off_diagonal);
};

} // namespace dss
