#include "solver/statics/cholmod_factor.hpp"

#include <Eigen/CholmodSupport>

#include <algorithm>
#include <limits>
#include <new>

namespace dss {
namespace {

constexpr double entry_bytes = sizeof(double) + sizeof(int);

cholmod_sparse view(const CholmodFactor::Matrix& lower) {
  return Eigen::viewAsCholmod(lower.selfadjointView<Eigen::Lower>());
}

template <class Result>
Result* require(Result* result) {
  if (!result) throw std::bad_alloc();
  return result;
}

} // namespace

CholmodFactor::CholmodFactor() : library_(cholmod()) {
  library_.start(&common_);
  common_.print = 0;
  common_.quick_return_if_not_posdef = true;
}

CholmodFactor::~CholmodFactor() {
  library_.free_factor(&factor_, &common_);
  for (cholmod_dense** dense : {&solution_, &work_y_, &work_e_})
    library_.free_dense(dense, &common_);
  library_.finish(&common_);
}

void CholmodFactor::analyse(const Matrix& lower) {
  library_.free_factor(&factor_, &common_);
  cholmod_sparse a = view(lower);
  factor_ = library_.analyze(&a, &common_);
}

void CholmodFactor::analyse_like(const CholmodFactor& other, const Matrix& lower) {
  common_.supernodal = CHOLMOD_SIMPLICIAL;
  common_.nmethods = 1;
  common_.method[0].ordering = CHOLMOD_GIVEN;
  library_.free_factor(&factor_, &common_);
  cholmod_sparse a = view(lower);
  factor_ =
      require(library_.analyze_p(&a, static_cast<int*>(other.factor_->Perm), nullptr, 0, &common_));
}

void CholmodFactor::factorise(const Matrix& lower) {
  const CholmodLoops loops;
  cholmod_sparse a = view(lower);
  library_.factorize(&a, factor_, &common_);
  if (common_.status < CHOLMOD_OK) throw std::bad_alloc();
}

void CholmodFactor::forget_numbers() {
  library_.change_factor(CHOLMOD_PATTERN, factor_->is_ll, factor_->is_super, true, true, factor_,
                         &common_);
}

Eigen::Map<const Eigen::MatrixXd> CholmodFactor::solve(const Eigen::Ref<const Eigen::MatrixXd>& b) {
  cholmod_dense view_of_b{};
  view_of_b.nrow = std::size_t(b.rows());
  view_of_b.ncol = std::size_t(b.cols());
  view_of_b.d = std::size_t(b.outerStride());
  view_of_b.nzmax = view_of_b.d * view_of_b.ncol;
  view_of_b.x = const_cast<double*>(b.data()); // CHOLMOD reads it
  view_of_b.xtype = CHOLMOD_REAL;
  view_of_b.dtype = CHOLMOD_DOUBLE;
  const CholmodLoops loops;
  if (!library_.solve2(CHOLMOD_A, factor_, &view_of_b, nullptr, &solution_, nullptr, &work_y_,
                       &work_e_, &common_))
    throw std::bad_alloc();
  return {static_cast<const double*>(solution_->x), b.rows(), b.cols()};
}

double CholmodFactor::bytes(const Matrix& lower) const {
  if (!factor_) return std::numeric_limits<double>::infinity();
  const double permuted = 2 * entry_bytes * double(lower.nonZeros());
  const double columns = common_.grow1 * entry_bytes * common_.lnz; // of L D L^T
  const double blocks = sizeof(double) * double(factor_->xsize + factor_->maxcsize) +
                        sizeof(int) * double(factor_->ssize);
  return permuted + (factor_->is_super ? std::max(columns, blocks) : columns);
}

std::vector<double> CholmodFactor::pivots() const {
  std::vector<double> found;
  const auto* x = static_cast<const double*>(factor_->x);
  const auto* start = static_cast<const int*>(factor_->is_super ? factor_->px : factor_->p);
  const auto add = [&](double entry) {
    if (found.size() < factor_->minor) found.push_back(is_cholesky() ? entry * entry : entry);
  };
  if (factor_->is_super) {
    const auto* first = static_cast<const int*>(factor_->super);
    const auto* rows = static_cast<const int*>(factor_->pi);
    for (std::size_t s = 0; s < factor_->nsuper; ++s)
      for (int c = 0; c < first[s + 1] - first[s]; ++c)
        add(x[start[s] + c * (rows[s + 1] - rows[s]) + c]);
  } else {
    for (std::size_t k = 0; k < factor_->n; ++k) add(x[start[k]]);
  }
  if (!is_complete()) found.push_back(0);
  return found;
}

} // namespace dss
