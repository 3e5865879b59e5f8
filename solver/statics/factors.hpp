#pragma once
/// Triangular factors of symmetric sparse matrices.
#include <Eigen/SparseCore>

#include <memory>
#include <optional>
#include <string>

namespace dss {

/// Empty, or why this machine cannot make factors: it lacks CHOLMOD.
std::string why_no_factors();

/// Sets the threads of all factors of this process; one at first.
/// @return the number they have then
/// @throws InputError if this machine lacks CHOLMOD
int set_factor_threads(int count);

/// Factors of a symmetric matrix, given by its lower half, by CHOLMOD: L L^T of a positive definite
/// matrix, L D L^T of any other. The order of elimination is the better one of minimum degree and
/// nested dissection. Columns are joined to dense blocks where that pays.
class Factors {
public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// @throws InputError if this machine lacks CHOLMOD
  Factors();
  ~Factors();

  /// Finds the order of elimination, unless that of the last matrix does: its entries had the same
  /// places.
  /// @return whether a new order was found
  bool analyse(const Matrix& lower);
  /// Analyses and factorises.
  void compute(const Matrix& lower);

  double work() const; ///< multiplications of a factorisation; call analyse first
  /// Memory while a factorisation runs, of a definite matrix or another; infinite if CHOLMOD cannot
  /// address it. Call analyse first.
  double bytes() const;

  /// False if a pivot is zero, so that the equations cannot be solved.
  bool are_complete() const;
  /// Solves the equations for each column. Call only if the factors are complete.
  /// @return valid until the next call
  Eigen::Map<const Eigen::MatrixXd>
  solve(const Eigen::Ref<const Eigen::MatrixXd>& right_hand_sides) const;

  /// Number of negative pivots of the columns done. By Sylvester's law it is the number of negative
  /// eigenvalues.
  long negative_pivots() const;
  /// Unknown whose pivot is zero, to rounding, compared with its diagonal entry; nothing if there
  /// is none. It is a motion that takes no force.
  std::optional<Eigen::Index> zero_pivot(const Matrix& lower) const;

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

} // namespace dss
