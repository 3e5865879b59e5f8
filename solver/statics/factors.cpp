#include "solver/statics/factors.hpp"

#include "solver/statics/cholmod_factor.hpp"
#include "solver/statics/cholmod_library.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace dss {
namespace {

using Eigen::Index;
using Matrix = Factors::Matrix;

constexpr double zero_pivot_share = 1e-12;

} // namespace

std::string why_no_factors() { return why_no_cholmod(); }
int set_factor_threads(int count) { return use_cholmod_threads(count); }

struct Factors::Data {
  bool has_pattern_of(const Matrix& lower) const {
    return std::ranges::equal(starts, outer(lower)) && std::ranges::equal(rows, inner(lower));
  }
  static std::span<const int> outer(const Matrix& lower) {
    return {lower.outerIndexPtr(), std::size_t(lower.outerSize()) + 1};
  }
  static std::span<const int> inner(const Matrix& lower) {
    return {lower.innerIndexPtr(), std::size_t(lower.nonZeros())};
  }

  CholmodFactor definite, indefinite;
  CholmodFactor* used = &definite;
  std::vector<int> starts, rows;     ///< places of the entries that were analysed
  bool has_indefinite_order = false; ///< of these entries
  double bytes = 0;
  std::vector<double> pivots;
};

Factors::Factors() : data_(std::make_unique<Data>()) {}
Factors::~Factors() = default;

bool Factors::analyse(const Matrix& lower) {
  if (data_->has_pattern_of(lower)) return false;
  const auto outer = Data::outer(lower), inner = Data::inner(lower);
  data_->starts.assign(outer.begin(), outer.end());
  data_->rows.assign(inner.begin(), inner.end());
  data_->definite.analyse(lower);
  data_->has_indefinite_order = false;
  data_->bytes = data_->definite.bytes(lower);
  return true;
}

void Factors::compute(const Matrix& lower) {
  analyse(lower);
  data_->used = &data_->definite;
  data_->definite.factorise(lower);
  if (data_->definite.is_cholesky() && !data_->definite.is_complete()) {
    data_->definite.forget_numbers();
    if (!data_->has_indefinite_order) data_->indefinite.analyse_like(data_->definite, lower);
    data_->has_indefinite_order = true;
    data_->indefinite.factorise(lower);
    data_->used = &data_->indefinite;
  }
  data_->pivots = data_->used->pivots();
}

double Factors::work() const { return data_->definite.work(); }
double Factors::bytes() const { return data_->bytes; }
bool Factors::are_complete() const { return data_->used->is_complete(); }
Eigen::Map<const Eigen::MatrixXd> Factors::solve(const Eigen::Ref<const Eigen::MatrixXd>& b) const {
  return data_->used->solve(b);
}

long Factors::negative_pivots() const {
  return std::ranges::count_if(data_->pivots, [](double pivot) { return pivot < 0; });
}

std::optional<Index> Factors::zero_pivot(const Matrix& lower) const {
  const Eigen::VectorXd diagonal = lower.diagonal();
  const auto order = data_->used->order();
  for (std::size_t k = 0; k < data_->pivots.size(); ++k)
    if (std::abs(data_->pivots[k]) <= zero_pivot_share * std::abs(diagonal[order[k]]))
      return order[k]; // a zero pivot leaves the later ones unset
  return {};
}

} // namespace dss
