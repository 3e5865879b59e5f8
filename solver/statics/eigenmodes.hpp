#pragma once
/// Lowest natural modes of a linearised problem: K x = omega^2 M x.
#include "solver/statics/static_system.hpp"

namespace dss {

/// Eigenvalues of (K, M) and their modes.
struct Eigenmodes {
  Eigen::VectorXd values; ///< omega^2 [rad^2/s^2], ascending
  Eigen::MatrixXd shapes; ///< one column each, x^T M x = 1
};

/// The `count` smallest eigenvalues of (K, M) and their modes. Method: block Lanczos process with
/// full orthogonalisation on (K - shift M)^-1 M (G. H. Golub, R. Underwood 1977). Sylvester's law
/// then counts the eigenvalues below the largest, so that none of several equal ones is missing.
/// @param stiffness, mass  lower halves
/// @param shift  below all eigenvalues; K - shift M is not singular
/// @throws InputError if the modes are not found
Eigenmodes lowest_modes(const SparseMatrix& stiffness, const SparseMatrix& mass, int count,
                        double shift = 0);

/// Number of eigenvalues of (K, M) below `value`.
long count_below(const SparseMatrix& stiffness, const SparseMatrix& mass, double value);

} // namespace dss
