#pragma once
/// Symmetric sparse equations, by factors or by conjugate gradients.
#include "solver/statics/factors.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

namespace dss {

/// direct: factors. cg: preconditioned conjugate gradients. automatic: the one with less expected
/// work, among those that fit in memory. The order of elimination gives the work and the memory of
/// the factors before they are computed.
enum class SolverKind { automatic, direct, cg };
/// Preconditioner of conjugate gradients. block_jacobi has blocks of 6 x 6.
enum class Preconditioner { incomplete_cholesky, block_jacobi };

/// Solver for a sequence of symmetric matrices: prepare() each matrix, then solve().
class SparseSolver {
public:
  /// @param cg_iterations  expected iterations of conjugate gradients, for `automatic`
  explicit SparseSolver(SolverKind kind,
                        Preconditioner preconditioner = Preconditioner::incomplete_cholesky,
                        double cg_iterations = 1000)
      : kind_(kind), is_automatic_(kind == SolverKind::automatic), preconditioner_(preconditioner),
        cg_iterations_(cg_iterations) {}

  /// Selects conjugate gradients with block Jacobi. For a singular matrix, whose incomplete factors
  /// would be singular too.
  void take_conjugate_gradients() {
    kind_ = SolverKind::cg;
    preconditioner_ = Preconditioner::block_jacobi;
  }

  /// Computes the factors or the preconditioner of a matrix, given by its lower half. The first
  /// matrix decides what `automatic` is.
  /// @throws InputError if factors were asked for and do not fit in memory
  void prepare(const Eigen::SparseMatrix<double>& lower);
  /// Solves the equations; call prepare first. Conjugate gradients end when the error, measured by
  /// the preconditioner, has fallen by `reduction`.
  /// @return nothing if they do not end, or meet a direction without stiffness
  std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& right_hand_side,
                                       double reduction = 1e-10);

  bool is_direct() const { return kind_ == SolverKind::direct; }
  std::string_view name() const;
  const Factors& factors() const { return *factors_; } ///< of the direct solver
  long iterations() const {
    return iterations_;
  } ///< of conjugate gradients, in all solutions
    ///< so far
  /// True if conjugate gradients met a direction whose stiffness is not positive.
  bool met_no_stiffness() const { return met_no_stiffness_; }

private:
  using Apply = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
  void choose(const Eigen::SparseMatrix<double>& lower);
  std::optional<Eigen::VectorXd> conjugate_gradients(const Eigen::VectorXd& right_hand_side,
                                                     double reduction);
  void make_preconditioner();

  SolverKind kind_;
  bool is_automatic_;
  Preconditioner preconditioner_;
  double cg_iterations_;
  std::unique_ptr<Factors> factors_; ///< of the direct solver
  bool met_no_stiffness_ = false;
  Eigen::SparseMatrix<double> lower_; ///< for conjugate gradients
  Apply precondition_;
  long iterations_ = 0;
};

} // namespace dss
