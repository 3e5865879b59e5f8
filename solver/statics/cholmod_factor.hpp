#pragma once
/// A factor of a symmetric sparse matrix, as CHOLMOD has it.
#include "solver/statics/cholmod_library.hpp"

#include <Eigen/SparseCore>

#include <span>
#include <vector>

namespace dss {

/// CHOLMOD's factor with its settings and work space. Matrices are given by their lower halves.
class CholmodFactor {
public:
  using Matrix = Eigen::SparseMatrix<double>;

  CholmodFactor();
  ~CholmodFactor();
  CholmodFactor(const CholmodFactor&) = delete;

  /// Finds an order of elimination, and blocks where these pay: then factorise() computes L L^T,
  /// else L D L^T. Leaves no factor if it would have too many entries for CHOLMOD.
  void analyse(const Matrix& lower);
  /// Takes the order of another factor, for L D L^T without blocks.
  void analyse_like(const CholmodFactor& other, const Matrix& lower);
  /// @throws std::bad_alloc if the memory does not suffice
  void factorise(const Matrix& lower);
  /// Keeps the order and forgets the numbers.
  void forget_numbers();
  /// Solves the equations for each column. @return valid until the next call
  Eigen::Map<const Eigen::MatrixXd>
  solve(const Eigen::Ref<const Eigen::MatrixXd>& right_hand_sides);

  double work() const { return common_.fl; } ///< multiplications of a factorisation
  /// Memory while a matrix is factorised, even if it is not positive definite; infinite if there is
  /// no factor.
  double bytes(const Matrix& lower) const;
  bool is_cholesky() const { return factor_->is_super || factor_->is_ll; } ///< L L^T
  bool is_complete() const { return factor_->minor == factor_->n; }
  /// Unknown of each pivot.
  std::span<const int> order() const {
    return {static_cast<const int*>(factor_->Perm), factor_->n};
  }
  /// Entries of D, up to the first that is zero. L L^T has their roots on its diagonal.
  std::vector<double> pivots() const;

private:
  const CholmodLibrary& library_;
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *solution_ = nullptr, *work_y_ = nullptr, *work_e_ = nullptr; ///< of solve()
};

} // namespace dss
