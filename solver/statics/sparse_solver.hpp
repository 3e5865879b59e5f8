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

/// direct: factors L D L^T in an approximate minimum degree order. cg: preconditioned conjugate
/// gradients. automatic: the one with less expected work. The order of elimination gives the work
/// of the factors before they are computed.
enum class SolverKind { automatic, direct, cg };
/// Preconditioner of conjugate gradients. block_jacobi has blocks of 6 x 6.
enum class Preconditioner { incomplete_cholesky, block_jacobi };

/// Eigen's factors, with access to Eigen's protected data.
class Factors : public Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> {
public:
  /// Multiplications of a factorisation. Call analyzePattern first.
  double work() const;
  /// Number of negative pivots of the columns done. By Sylvester's law it is the number of negative
  /// eigenvalues.
  long negative_pivots() const;
  /// Unknown whose pivot is zero, to rounding, compared with its diagonal entry; nothing if there
  /// is none. It is a motion that takes no force.
  std::optional<Eigen::Index> zero_pivot(const Eigen::SparseMatrix<double>& lower) const;
  double nonzeros() const;
};

/// Solver for a sequence of symmetric matrices: prepare() each matrix, then solve().
class SparseSolver {
public:
  /// @param cg_iterations  expected iterations of conjugate gradients, for `automatic`
  explicit SparseSolver(SolverKind kind,
                        Preconditioner preconditioner = Preconditioner::incomplete_cholesky,
                        double cg_iterations = 1000)
      : kind_(kind), preconditioner_(preconditioner), cg_iterations_(cg_iterations) {}

  /// Selects conjugate gradients with block Jacobi. For a singular matrix, whose incomplete factors
  /// would be singular too.
  void take_conjugate_gradients() {
    kind_ = SolverKind::cg;
    preconditioner_ = Preconditioner::block_jacobi;
  }

  /// Computes the factors or the preconditioner of a matrix, given by its lower half. The first
  /// matrix decides what `automatic` is.
  void prepare(const Eigen::SparseMatrix<double>& lower);
  /// Solves the equations; call prepare first. Conjugate gradients end when the error, measured by
  /// the preconditioner, has fallen by `reduction`.
  /// @return nothing if they do not end, or meet a direction without stiffness
  std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& right_hand_side,
                                       double reduction = 1e-10);

  bool is_direct() const { return kind_ == SolverKind::direct; }
  std::string_view name() const;
  const Factors& factors() const { return factors_; } ///< of the direct solver
  long iterations() const {
    return iterations_;
  } ///< of conjugate gradients, in all solutions
    ///< so far
  /// True if conjugate gradients met a direction whose stiffness is not positive.
  bool met_no_stiffness() const { return met_no_stiffness_; }

private:
  using Apply = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
  std::optional<Eigen::VectorXd> conjugate_gradients(const Eigen::VectorXd& right_hand_side,
                                                     double reduction);
  void make_preconditioner();

  SolverKind kind_;
  Preconditioner preconditioner_;
  double cg_iterations_;
  Factors factors_;
  bool is_analysed_ = false, met_no_stiffness_ = false;
  Eigen::SparseMatrix<double> lower_; ///< for conjugate gradients
  Apply precondition_;
  long iterations_ = 0;
};

} // namespace dss
