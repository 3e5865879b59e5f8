#pragma once
/// Eigenvalues of dense matrices. Each function serves matrices of every size, because Eigen's
/// solvers take seconds to compile for each type.
#include <Eigen/Core>

namespace dss {

/// Eigenvalues of a symmetric matrix, ascending, and its orthonormal eigenvectors in the same
/// order, one a column.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;

  /// Reads the lower triangle.
  explicit SymmetricEigen(const Eigen::MatrixXd& matrix);
  /// For a tridiagonal matrix: n entries on the diagonal, n - 1 beside it.
  SymmetricEigen(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& off_diagonal);
};

/// Eigenvalues of a square matrix, in no order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);
/// Largest absolute value of the eigenvalues of a square matrix.
double spectral_radius(const Eigen::MatrixXd& matrix);

} // namespace dss
