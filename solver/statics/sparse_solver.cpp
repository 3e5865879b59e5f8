#include "solver/statics/sparse_solver.hpp"

#include "solver/memory.hpp"

#include <Eigen/Cholesky>
#include <Eigen/IterativeLinearSolvers>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;

// One multiplication of a factorisation takes as long as this number of multiplications of
// conjugate gradients: blocks run at the peak of the core, conjugate gradients at that of the
// memory.
constexpr double weight_of_factors = 0.1;
/// Beyond that, orders of elimination take minutes, and conjugate gradients always less work.
constexpr Index most_unknowns_to_analyse = 3'000'000;
constexpr double cg_work = 8; ///< multiplications of an iteration for each entry of the lower half

/// Inverses of diagonal blocks of six successive unknowns. Without clamps a block is an element.
class BlockJacobi {
public:
  explicit BlockJacobi(const Matrix& lower) : size_(lower.rows()) {
    std::vector<Eigen::MatrixXd> blocks;
    for (Index first = 0; first < size_; first += block) {
      const Index own = std::min(block, size_ - first);
      blocks.push_back(Eigen::MatrixXd::Zero(own, own));
    }
    for (Index column = 0; column < size_; ++column)
      for (Matrix::InnerIterator entry(lower, column); entry; ++entry)
        if (entry.row() / block == column / block)
          blocks[std::size_t(column / block)](entry.row() % block, column % block) = entry.value();
    for (const Eigen::MatrixXd& one : blocks)
      inverses_.emplace_back(one.selfadjointView<Eigen::Lower>());
  }
  VectorXd operator()(const VectorXd& x) const {
    VectorXd result(size_);
    for (Index n = 0; n < Index(inverses_.size()); ++n) {
      const Index own = std::min(block, size_ - n * block);
      result.segment(n * block, own) = inverses_[std::size_t(n)].solve(x.segment(n * block, own));
    }
    return result;
  }

private:
  static constexpr Index block = 6;
  Index size_;
  std::vector<Eigen::LDLT<Eigen::MatrixXd>> inverses_;
};

} // namespace

std::string_view SparseSolver::name() const {
  if (is_direct()) return "direct";
  return preconditioner_ == Preconditioner::block_jacobi ? "cg, block Jacobi"
                                                         : "cg, incomplete Cholesky";
}

/// Analyses a matrix for factors, and decides what `automatic` is.
void SparseSolver::choose(const Matrix& lower) {
  const auto size = lower.rows();
  if (is_automatic_ && size > most_unknowns_to_analyse) kind_ = SolverKind::cg;
  if (kind_ == SolverKind::cg) return;
  if (!factors_) factors_ = std::make_unique<Factors>();
  if (!factors_->analyse(lower)) return;
  if (!is_automatic_)
    return require_memory(factors_->bytes(), fmt::format("factors of {} unknowns", size),
                          "give --solver cg, relaxation or auto");
  const double of_cg = cg_work * cg_iterations_ * double(lower.nonZeros());
  const bool is_less = weight_of_factors * factors_->work() <= of_cg;
  kind_ = is_less && factors_->bytes() <= available_memory() ? SolverKind::direct : SolverKind::cg;
}

void SparseSolver::prepare(const Matrix& lower) {
  choose(lower);
  if (is_direct()) {
    factors_->compute(lower);
  } else {
    lower_ = lower;
    make_preconditioner();
  }
}

void SparseSolver::make_preconditioner() {
  if (preconditioner_ == Preconditioner::block_jacobi) {
    precondition_ = BlockJacobi(lower_);
    return;
  }
  using Incomplete = Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>>;
  const auto incomplete = std::make_shared<Incomplete>(lower_);
  precondition_ = [incomplete](const VectorXd& x) { return VectorXd(incomplete->solve(x)); };
}

std::optional<VectorXd> SparseSolver::solve(const VectorXd& right_hand_side, double reduction) {
  if (!is_direct()) return conjugate_gradients(right_hand_side, reduction);
  if (!factors_->are_complete()) return {};
  return factors_->solve(right_hand_side);
}

std::optional<VectorXd> SparseSolver::conjugate_gradients(const VectorXd& b, double reduction) {
  const Index most_iterations = 4 * b.size() + 1000;
  VectorXd x = VectorXd::Zero(b.size()), r = b, z = precondition_(r), p = z;
  double rz = r.dot(z);
  const double wanted = reduction * reduction * rz;
  met_no_stiffness_ = false;
  if (rz == 0) return x;
  for (Index n = 0; n < most_iterations && std::isfinite(rz); ++n, ++iterations_) {
    const VectorXd kp = lower_.selfadjointView<Eigen::Lower>() * p;
    const double pkp = p.dot(kp);
    if (!(pkp > 0)) {
      met_no_stiffness_ = true;
      return {};
    }
    const double step = rz / pkp;
    x += step * p;
    r -= step * kp;
    z = precondition_(r);
    const double next = r.dot(z);
    if (next <= wanted) return x;
    p = z + next / rz * p;
    rz = next;
  }
  return {};
}

} // namespace dss
