#pragma once
#include <Eigen/Core>

namespace dss {

/// Eigenvalues of a symmetric matrix, ascending, and its orthonormal eigenvectors in the same order, one a column. Of matrices of any size by one
/// function, since Eigen's solver takes seconds to compile for each type.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;

  /// Reads the lower triangle.
  explicit SymmetricEigen(const Eigen::MatrixXd& matrix);
  /// Of a tridiagonal matrix: its diagonal, n entries, and what is beside it, n - 1.
  SymmetricEigen(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& off_diagonal);
};

} // namespace dss
