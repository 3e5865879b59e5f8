#pragma once
/// Symmetric sparse equations, by factors or by conjugate gradients.
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace dss {

/// direct: L D L^T in an approximate minimum degree order. cg: preconditioned conjugate gradients. automatic: direct where its factors take
/// little work, as the order of elimination tells before any is done.
enum class SolverKind { automatic, direct, cg };
enum class Preconditioner { incomplete_cholesky, block_jacobi };

/// Eigen's factors, with what it keeps to itself.
class Factors : public Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> {
public:
  /// Multiplications of a factorisation, once analyzePattern was called.
  double work() const;
  /// Of the columns that were reached: negative pivots, by Sylvester's law as many as negative eigenvalues.
  long negative_pivots() const;
  /// The unknown whose pivot is zero to rounding beside its diagonal entry, if there is one: a motion that takes no force.
  std::optional<Eigen::Index> zero_pivot(const Eigen::SparseMatrix<double>& lower) const;
  double nonzeros() const;
};

class SparseSolver {
public:
  explicit SparseSolver(SolverKind kind, Preconditioner preconditioner = Preconditioner::incomplete_cholesky)
      : kind_(kind), preconditioner_(preconditioner) {}

  /// For a matrix that is singular, of which incomplete factors would be too.
  void take_conjugate_gradients() {
    kind_ = SolverKind::cg;
    preconditioner_ = Preconditioner::block_jacobi;
  }

  /// Factors of a matrix whose lower half is given, or its preconditioner. The first matrix settles what `automatic` is.
  void prepare(const Eigen::SparseMatrix<double>& lower);
  /// Once prepared. Conjugate gradients end when the error, measured by the preconditioner, has fallen by `reduction`.
  /// @return nothing if they do not, or meet a direction without stiffness
  std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& right_hand_side, double reduction = 1e-10);

  bool is_direct() const { return kind_ == SolverKind::direct; }
  std::string_view name() const;
  const Factors& factors() const { return factors_; } ///< of the direct one
  long iterations() const { return iterations_; }     ///< of all conjugate gradients so far
  /// A direction along which conjugate gradients met a stiffness that is not positive.
  bool met_no_stiffness() const { return met_no_stiffness_; }

private:
  using Apply = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
  std::optional<Eigen::VectorXd> conjugate_gradients(const Eigen::VectorXd& right_hand_side, double reduction);
  void make_preconditioner();

  SolverKind kind_;
  Preconditioner preconditioner_;
  Factors factors_;
  bool is_analysed_ = false, met_no_stiffness_ = false;
  Eigen::SparseMatrix<double> lower_; ///< for conjugate gradients
  Apply precondition_;
  long iterations_ = 0;
};

} // namespace dss
