#pragma once
/// Lowest natural modes of a linearised problem: K x = omega^2 M x.
#include "solver/statics/static_system.hpp"

namespace dss {

struct Eigenmodes {
  Eigen::VectorXd values; ///< omega^2 [rad^2/s^2], ascending
  Eigen::MatrixXd shapes; ///< a column each, x^T M x = 1
};

/// The `count` smallest eigenvalues of (K, M) and their modes, by the block Lanczos process with full orthogonalisation on (K - shift M)^-1 M
/// (G. H. Golub, R. Underwood 1977); `shift` is below all of them, and K - shift M not singular. Sylvester's law then counts the eigenvalues below the
/// largest, so that none is missing, however many are equal.
/// @param stiffness, mass  lower halves  @throws InputError if they are not found
Eigenmodes lowest_modes(const SparseMatrix& stiffness, const SparseMatrix& mass, int count, double shift = 0);

/// Eigenvalues of (K, M) below a number.
long count_below(const SparseMatrix& stiffness, const SparseMatrix& mass, double value);

} // namespace dss
