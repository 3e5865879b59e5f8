#include "solver/statics/eigenmodes.hpp"
#include "solver/error.hpp"
#include "solver/numerics/dense_eigen.hpp"
#include "solver/statics/factors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <random>

namespace dss {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Largest residual of an eigenvector, over its eigenvalue of the inverse.
constexpr double tolerance = 1e-11;
constexpr Index first_block = 6; ///< a free body has this many equal eigenvalues
constexpr int most_attempts = 3; ///< each with twice the block

/// A space with a basis orthonormal over the mass. It grows by the inverse applied to its newest
/// block.
class BlockLanczos {
public:
  BlockLanczos(const Factors& factors, const SparseMatrix& mass, Index block)
      : factors_(factors), mass_(mass), block_(std::min(block, mass.rows())) {}

  /// Finds the `count` largest eigenvalues of the inverse, descending, and their vectors.
  /// @return false if they do not converge
  bool find(Index count, VectorXd& values, MatrixXd& vectors) {
    const Index most = std::min(mass_.rows(), 20 * count + 40 * block_);
    basis_.resize(mass_.rows(), std::min(most + block_, 8 * block_));
    MatrixXd next = random_block(block_);
    while (size_ < most) {
      const Index added = append(next);
      if (added == 0) break; // the space is closed
      next = factors_.solve(mass_product(space().rightCols(added)));
      const MatrixXd outside = project(next, added);
      const SymmetricEigen ritz(projected_);
      const Index have = std::min(count, size_);
      values = ritz.values.tail(have).reverse();
      const MatrixXd small = ritz.vectors.rightCols(have).rowwise().reverse();
      // The part of (inverse x - value x) outside the space comes from the newest block alone.
      const MatrixXd gram = outside.transpose() * mass_product(outside);
      const MatrixXd ends = small.bottomRows(added);
      const VectorXd residual = (ends.transpose() * gram * ends).diagonal().cwiseMax(0).cwiseSqrt();
      const bool is_whole = size_ == mass_.rows();
      if (have == count &&
          (is_whole || (residual.array() <= tolerance * values.array().abs()).all())) {
        vectors = space() * small;
        return true;
      }
    }
    return false;
  }

private:
  MatrixXd mass_product(const MatrixXd& x) const {
    return mass_.selfadjointView<Eigen::Lower>() * x;
  }

  MatrixXd random_block(Index columns) {
    std::normal_distribution<double> normal;
    return MatrixXd::NullaryExpr(mass_.rows(), columns, [&] { return normal(generator_); });
  }

  MatrixXd::ConstColsBlockXpr space() const { return basis_.leftCols(size_); }
  double norm(const VectorXd& x) const {
    return std::sqrt(std::max(0.0, x.dot(VectorXd(mass_product(x)))));
  }

  /// Adds the new directions of a block, vector by vector. Repeats the orthogonalisation if little
  /// is left of a vector.
  /// @return number of added vectors
  Index append(const MatrixXd& block) {
    const Index before = size_;
    for (Index c = 0; c < block.cols() && size_ < mass_.rows(); ++c) {
      VectorXd x = block.col(c);
      double size = norm(x);
      for (int pass = 0; pass < 3 && size > 0; ++pass) {
        x -= space() * (space().transpose() * mass_product(x));
        const double left = norm(x);
        x /= left;
        size = left > 1e-10 * size ? 1 : 0;
      }
      if (size == 0) continue;
      if (size_ == basis_.cols()) basis_.conservativeResize(Eigen::NoChange, 2 * size_);
      basis_.col(size_++) = x;
    }
    return size_ - before;
  }

  /// Updates the inverse projected on the space. The last `added` columns of the space are new;
  /// `images` are the inverse applied to them.
  /// @return part of the images outside the space
  MatrixXd project(const MatrixXd& images, Index added) {
    const MatrixXd columns = space().transpose() * mass_product(images);
    projected_.conservativeResize(size_, size_);
    projected_.rightCols(added) = columns;
    projected_.bottomRows(added) = columns.transpose();
    const MatrixXd corner = projected_.bottomRightCorner(added, added);
    projected_.bottomRightCorner(added, added) = (corner + corner.transpose()) / 2;
    return images - space() * columns;
  }

  const Factors& factors_;
  const SparseMatrix& mass_;
  Index block_;
  std::mt19937_64 generator_{1};
  MatrixXd basis_; ///< its first `size_` columns are used
  Index size_ = 0;
  MatrixXd projected_;
};

SparseMatrix shifted(const SparseMatrix& stiffness, const SparseMatrix& mass, double shift) {
  return stiffness - shift * mass;
}

/// A number between the largest eigenvalue and the next lower one that is not equal to it, and the
/// number of eigenvalues below.
struct Cut {
  double value = 0;
  long below = 0;
};
Cut cut_below(const VectorXd& values, double shift) {
  const double spread = 1e-6 * (values[values.size() - 1] - shift);
  for (Index n = values.size() - 1; n > 0; --n)
    if (values[n] - values[n - 1] > spread) return {(values[n] + values[n - 1]) / 2, long(n)};
  return {values[0] - spread, 0};
}

} // namespace

long count_below(const SparseMatrix& stiffness, const SparseMatrix& mass, double value) {
  Factors factors;
  factors.compute(shifted(stiffness, mass, value));
  if (!factors.are_complete()) throw InputError("eigenvalues cannot be counted: a pivot is zero");
  return factors.negative_pivots();
}

Eigenmodes lowest_modes(const SparseMatrix& stiffness, const SparseMatrix& mass, int count,
                        double shift) {
  const Index wanted = std::min<Index>(count, mass.rows());
  Factors factors;
  factors.compute(shifted(stiffness, mass, shift));
  for (int attempt = 0; attempt < most_attempts && factors.are_complete(); ++attempt) {
    VectorXd inverse;
    Eigenmodes found;
    if (!BlockLanczos(factors, mass, first_block << attempt).find(wanted, inverse, found.shapes))
      continue;
    if ((inverse.array() <= 0).any()) break; // an eigenvalue is below the shift
    found.values = inverse.cwiseInverse().array() + shift;
    const Cut cut = cut_below(found.values, shift);
    if (count_below(stiffness, mass, cut.value) == cut.below) return found;
  }
  throw InputError(
      "the lowest natural frequencies were not found: is something free to move, or buckled?");
}

} // namespace dss
