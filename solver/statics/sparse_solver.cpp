#include "solver/statics/sparse_solver.hpp"

#include <Eigen/Cholesky>
#include <Eigen/IterativeLinearSolvers>

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;

// One multiplication of a factorisation takes as long as this number of multiplications of
// conjugate gradients.
constexpr double weight_of_factors = 3;
constexpr double cg_work = 8; ///< multiplications of an iteration for each entry of the lower half
constexpr double zero_pivot_share = 1e-12;

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

double Factors::work() const {
  double sum = 0;
  for (Index column = 0; column < m_nonZerosPerCol.size(); ++column)
    sum += double(m_nonZerosPerCol[column]) * double(m_nonZerosPerCol[column]);
  return sum;
}

double Factors::nonzeros() const {
  return double(m_nonZerosPerCol.cast<double>().sum()) + double(m_diag.size());
}

long Factors::negative_pivots() const { return long((m_diag.array() < 0).count()); }

std::optional<Index> Factors::zero_pivot(const Matrix& lower) const {
  const VectorXd diagonal = lower.diagonal();
  const auto& place = permutationP().indices();
  std::vector<Index> unknown(std::size_t(diagonal.size()));
  for (Index n = 0; n < diagonal.size(); ++n) unknown[std::size_t(place[n])] = n;
  for (Index k = 0; k < m_diag.size(); ++k) {
    const Index n = unknown[std::size_t(k)];
    if (std::abs(m_diag[k]) <= zero_pivot_share * std::abs(diagonal[n]))
      return n; // a zero pivot leaves the later ones unset
  }
  return {};
}

std::string_view SparseSolver::name() const {
  if (is_direct()) return "direct";
  return preconditioner_ == Preconditioner::block_jacobi ? "cg, block Jacobi"
                                                         : "cg, incomplete Cholesky";
}

void SparseSolver::prepare(const Matrix& lower) {
  if (kind_ != SolverKind::cg && !is_analysed_) {
    factors_.analyzePattern(lower);
    is_analysed_ = true;
    if (kind_ == SolverKind::automatic)
      kind_ =
          weight_of_factors * factors_.work() <= cg_work * cg_iterations_ * double(lower.nonZeros())
              ? SolverKind::direct
              : SolverKind::cg;
  }
  if (is_direct()) {
    factors_.analyzePattern(lower); // entries may vanish or appear with the state
    factors_.factorize(lower);
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
  if (factors_.info() != Eigen::Success) return {};
  return factors_.solve(right_hand_side);
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
