#include "variants/sparse/linear_stages.hpp"

#include "solver/error.hpp"
#include "variants/sparse/step_factors.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dss {
namespace {

Eigen::VectorXd product(const SparseMatrix& lower, const Eigen::VectorXd& x) {
  return lower.selfadjointView<Eigen::Lower>() * x;
}

/// Field of the displacement or turn d of an element, and of its rate.
std::size_t field_of(std::size_t d) { return d < 3 ? ux + d : qx + d - 3; }
std::size_t rate_field_of(std::size_t d) { return d < 3 ? vx + d : wx + d - 3; }

} // namespace

LinearLoads::LinearLoads(const Problem& problem, const FreeDofs& dofs)
    : dofs_(dofs), dynamics_(problem, Rotation::linearised),
      rest_(problem.lattice.element_count * field_count, 0),
      wrenches_(6 * problem.lattice.element_count) {}

Eigen::VectorXd LinearLoads::evaluated(std::span<const double> state,
                                       std::span<const double> signals) {
  dynamics_.wrenches(state, signals, wrenches_);
  return Eigen::VectorXd::NullaryExpr(
      dofs_.size(), [&](Eigen::Index n) { return wrenches_[dofs_.dof[std::size_t(n)]]; });
}

void LinearLoads::add_pattern(std::size_t signal) {
  std::vector<double> signals(first_.size(), 0);
  signals[signal] = 1;
  const Eigen::VectorXd forces = evaluated(rest_, signals);
  Pattern& pattern = patterns_.emplace_back();
  pattern.signal = signal;
  for (Eigen::Index n = 0; n < forces.size(); ++n)
    if (forces[n] != 0) pattern.forces.emplace_back(n, forces[n]);
  has_pattern_[signal] = true;
}

const Eigen::VectorXd& LinearLoads::at(std::span<const double> held,
                                       std::span<const double> signals) {
  if (first_.empty()) {
    first_.assign(signals.begin(), signals.end());
    last_ = first_;
    has_pattern_.resize(first_.size(), false);
    return of_last_ = of_first_ = evaluated(held, signals);
  }
  if (std::ranges::equal(signals, last_)) return of_last_;
  last_.assign(signals.begin(), signals.end());
  for (std::size_t s = 0; s < last_.size(); ++s)
    if (last_[s] != first_[s] && !has_pattern_[s]) add_pattern(s);
  of_last_ = of_first_;
  for (const Pattern& pattern : patterns_)
    for (const auto& [n, force] : pattern.forces)
      of_last_[n] += (last_[pattern.signal] - first_[pattern.signal]) * force;
  return of_last_;
}

LinearStages::LinearStages(const Problem& problem, Model model, double share)
    : share_(share), dofs_(free_dofs(problem, degrees_of(model))),
      coordinates_(Rotation::linearised, problem.lattice.element_count),
      held_(problem.lattice.element_count * field_count, 0), loads_(problem, dofs_) {
  const StaticSystem system(problem, Rotation::linearised, degrees_of(model));
  mass_ = system.mass(system.rest()).diagonal();
  damping_ = system.damping_at_rest();
  stiffness_ = system.stiffness_at_rest();
  SparseMatrix matrix = share * damping_ + share * share * stiffness_;
  matrix += SparseMatrix(mass_.asDiagonal());
  factorise_step(matrix, factors_, info_);
  if (!factors_.are_complete())
    throw InputError(fmt::format(
        "{}: the matrix of an implicit step is singular; give another --dt", problem.name));
}

void LinearStages::write(std::size_t first, std::span<const double> fields, Vector& state) {
  const Eigen::Index size = dofs_.size();
  if (state.size() == 0) state = Vector::Zero(2 * size);
  std::ranges::copy(fields, held_.begin() + std::ptrdiff_t(first * field_count));
  for (std::size_t e = first; e < first + fields.size() / field_count; ++e) {
    double* own = &held_[e * field_count];
    reference::set_orientation_fields(own,
                                      coordinates_.write(e, reference::orientation_fields(own)));
    for (std::size_t d = 0; d < 6; ++d) {
      const Eigen::Index n = dofs_.index[6 * e + d];
      if (n < 0) continue;
      state[n] = std::exchange(own[field_of(d)], 0);
      state[size + n] = std::exchange(own[rate_field_of(d)], 0);
    }
  }
  loads_.restart();
}

void LinearStages::read(std::size_t first, std::span<double> fields, const Vector& state) {
  std::copy_n(held_.begin() + std::ptrdiff_t(first * field_count), fields.size(), fields.begin());
  for (std::size_t at = 0; at < fields.size(); at += field_count) {
    double* own = &fields[at];
    const std::size_t e = first + at / field_count;
    for (std::size_t d = 0; d < 6; ++d) {
      const Eigen::Index n = dofs_.index[6 * e + d];
      if (n < 0) continue;
      own[field_of(d)] = state[n];
      own[rate_field_of(d)] = state[dofs_.size() + n];
    }
    reference::set_orientation_fields(own,
                                      coordinates_.read(e, reference::orientation_fields(own)));
  }
}

void LinearStages::find_slope(const Vector& state, std::span<const double> signals, Vector& slope) {
  const Eigen::Index size = dofs_.size();
  slope.resize(state.size());
  slope.head(size) = state.tail(size);
  slope.tail(size) = (loads_.at(held_, signals) - product(stiffness_, state.head(size)) -
                      product(damping_, state.tail(size)))
                         .cwiseQuotient(mass_);
}

std::optional<std::size_t> LinearStages::solve(const Vector& base, std::span<const double> signals,
                                               Vector& slope) {
  const Eigen::Index size = dofs_.size();
  Vector right =
      loads_.at(held_, signals) - product(stiffness_, base.head(size) + share_ * base.tail(size));
  if (damping_.nonZeros() > 0) right -= product(damping_, base.tail(size));
  slope.resize(base.size());
  slope.tail(size) = factors_.solve(right);
  slope.head(size) = base.tail(size) + share_ * slope.tail(size);
  return std::nullopt;
}

std::string LinearStages::text() const {
  return fmt::format("sparse factors: {} unknowns", dofs_.size());
}

double LinearStages::bytes() const {
  const auto entries = double(damping_.nonZeros() + stiffness_.nonZeros());
  return factors_.bytes() + entries * (sizeof(double) + sizeof(int)) +
         double(held_.size()) * sizeof(double);
}

} // namespace dss
