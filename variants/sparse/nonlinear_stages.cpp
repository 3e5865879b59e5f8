#include "variants/sparse/nonlinear_stages.hpp"

#include "variants/sparse/step_factors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dss {
namespace {

constexpr int most_iterations = 40;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// New factors pay if a correction is more than this fraction of the one before.
constexpr double slow = 0.2;

/// Place of the rate of a degree of freedom (6 element + 0 .. 5) in a column of fields.
Eigen::Index rate_place(std::size_t dof) {
  const std::size_t axis = dof % 6;
  return Eigen::Index(dof / 6 * field_count + (axis < 3 ? vx + axis : wx + axis - 3));
}

/// Whether what is left after a correction is below rounding: it is about ratio / (1 - ratio) times
/// the correction if corrections fall by `ratio`. Or corrections fall no longer, and are rounding.
bool is_small(double size, double last, double scale, double noise) {
  if (size <= epsilon * scale) return true;
  const double ratio = size / last; // 0 at first
  if (ratio > 0.5) return size <= std::max(noise, 10 * epsilon * scale);
  return ratio > 0 && ratio / (1 - ratio) * size <= epsilon * scale;
}

} // namespace

NonlinearStages::NonlinearStages(const Problem& problem, Model model, Rotation rotation,
                                 double share)
    : share_(share), dynamics_(problem, rotation), system_(problem, rotation, degrees_of(model)),
      accelerations_(Vector::Zero(system_.size())) {
  problem.lattice.for_each_element([&](std::size_t, const Row& row, int) {
    const Body& body = problem.bodies[std::size_t(row.body)];
    gyration_.push_back(
        std::sqrt((body.inertia[0] + body.inertia[1] + body.inertia[2]) / (3 * body.mass)));
    edge_.push_back(std::max({body.edge[0], body.edge[1], body.edge[2]}));
  });
}

void NonlinearStages::write(std::size_t first, std::span<const double> fields, Vector& state) {
  if (state.size() == 0) state = Vector::Zero(Eigen::Index(gyration_.size() * field_count));
  std::ranges::copy(fields, state.data() + first * field_count);
  for (std::size_t e = first; e < first + fields.size() / field_count; ++e) {
    double* own = state.data() + e * field_count;
    reference::set_orientation_fields(
        own, dynamics_.coordinates().write(e, reference::orientation_fields(own)));
  }
  accelerations_.setZero();
  has_factors_ = false;
}

void NonlinearStages::read(std::size_t first, std::span<double> fields, const Vector& state) {
  std::copy_n(state.data() + first * field_count, fields.size(), fields.begin());
  for (std::size_t at = 0; at < fields.size(); at += field_count)
    reference::set_orientation_fields(
        &fields[at], dynamics_.coordinates().read(first + at / field_count,
                                                  reference::orientation_fields(&fields[at])));
}

void NonlinearStages::find_slope(const Vector& state, std::span<const double> signals,
                                 Vector& slope) {
  slope.resize(state.size());
  dynamics_.rates(std::span(state.data(), std::size_t(state.size())), signals,
                  std::span(slope.data(), std::size_t(slope.size())));
}

/// Y from the accelerations.
void NonlinearStages::place(const Vector& base) {
  reached_ = base;
  const FreeDofs& dofs = system_.dofs();
  for (Eigen::Index n = 0; n < dofs.size(); ++n) {
    reached_[rate_place(dofs.dof[std::size_t(n)])] += share_ * accelerations_[n];
  }
  for (std::size_t e = 0; e < gyration_.size(); ++e) {
    double* own = reached_.data() + e * field_count;
    for (int axis = 0; axis < 3; ++axis) own[ux + axis] += share_ * own[vx + axis];
    reference::set_orientation_fields(
        own, dynamics_.coordinates().midpoint(reference::orientation_fields(own),
                                              {own[wx], own[wy], own[wz]}, 2 * share_));
  }
}

/// @return false if the matrix is singular
bool NonlinearStages::renew_factors() {
  const StaticSystem::State state(reached_.begin(), reached_.end());
  mass_ = system_.mass(state);
  const SparseMatrix matrix = mass_ + share_ * system_.tangent(state, {share_, 1});
  factorise_step(matrix, factors_, info_);
  return has_factors_ = factors_.are_complete();
}

/// Largest velocity that accelerations add [m/s]. Angular velocities count at the radius of
/// gyration.
double NonlinearStages::speed(const Vector& accelerations) const {
  double largest = 0;
  for (Eigen::Index n = 0; n < accelerations.size(); ++n) {
    const std::size_t dof = system_.dofs().dof[std::size_t(n)];
    const double size =
        std::abs(share_ * accelerations[n]) * (dof % 6 < 3 ? 1 : gyration_[dof / 6]);
    if (!(size <= largest)) largest = size; // also if it is NaN
  }
  return largest;
}

/// Velocity that a hundred roundings of displacements, turns and velocities make [m/s]. Forces are
/// differences of such numbers.
double NonlinearStages::noise() const {
  double largest = 0;
  for (std::size_t e = 0; e < gyration_.size(); ++e) {
    const auto at = reached_.segment<field_count>(Eigen::Index(e * field_count));
    const double moved = at.segment<3>(ux).norm() + edge_[e] * at.segment<4>(qs).norm();
    largest = std::max({largest, at.segment<3>(vx).norm(), gyration_[e] * at.segment<3>(wx).norm(),
                        moved / share_});
  }
  return 100 * epsilon * largest;
}

bool NonlinearStages::iterate(const Vector& base, std::span<const double> signals, Vector& slope) {
  double last = std::numeric_limits<double>::infinity();
  bool are_factors_new = false;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    place(base);
    find_slope(reached_, signals, slope);
    if (!slope.allFinite()) {
      worst_ = element_of(first_not_finite(slope));
      return false;
    }
    if (!has_factors_) {
      if (!renew_factors()) return false;
      are_factors_new = true;
    }
    Vector missing(accelerations_.size());
    for (Eigen::Index n = 0; n < missing.size(); ++n) {
      const std::size_t dof = system_.dofs().dof[std::size_t(n)];
      missing[n] = slope[rate_place(dof)] - accelerations_[n];
    }
    const Vector residual = mass_.selfadjointView<Eigen::Lower>() * missing;
    worst_ = largest_of(residual);
    const Vector step = factors_.solve(residual);
    accelerations_ += step;
    const double size = speed(step), scale = speed(accelerations_);
    if (!std::isfinite(size)) return false;
    const double rounding = noise();
    if (is_small(size, last, scale, rounding)) {
      finish(base, slope);
      return true;
    }
    if (size > std::max(slow * last, rounding) && !are_factors_new) has_factors_ = false;
    are_factors_new = false;
    last = size;
  }
  return false;
}

/// The slope of the solution. Its accelerations are the unknowns: forces of stiff links would bring
/// their rounding.
void NonlinearStages::finish(const Vector& base, Vector& slope) {
  place(base);
  for (std::size_t e = 0; e < gyration_.size(); ++e) {
    const double* at = reached_.data() + e * field_count;
    double* rates = slope.data() + e * field_count;
    for (int axis = 0; axis < 3; ++axis) rates[ux + axis] = at[vx + axis];
    reference::set_orientation_fields(
        rates,
        dynamics_.coordinates().rate(reference::orientation_fields(at), {at[wx], at[wy], at[wz]}));
  }
  for (Eigen::Index n = 0; n < accelerations_.size(); ++n) {
    const std::size_t dof = system_.dofs().dof[std::size_t(n)];
    slope[rate_place(dof)] = accelerations_[n];
  }
}

/// Element of the largest number, or of one that is not finite.
std::size_t NonlinearStages::largest_of(const Vector& unknowns) const {
  Eigen::Index worst = 0;
  for (Eigen::Index n = 0; n < unknowns.size(); ++n)
    if (!(std::abs(unknowns[n]) <= std::abs(unknowns[worst]))) worst = n;
  return system_.dofs().dof[std::size_t(worst)] / 6;
}

std::optional<std::size_t> NonlinearStages::solve(const Vector& base,
                                                  std::span<const double> signals, Vector& slope) {
  if (iterate(base, signals, slope)) return std::nullopt;
  accelerations_.setZero(); // those of the last stage may be too far off
  has_factors_ = false;
  if (iterate(base, signals, slope)) return std::nullopt;
  return worst_;
}

std::string NonlinearStages::text() const {
  return fmt::format("sparse factors: {} unknowns, Newton", system_.size());
}

double NonlinearStages::bytes() const {
  return (has_factors_ ? factors_.bytes() : 0) + double(3 * reached_.size()) * sizeof(double) +
         double(dynamics_.bytes());
}

} // namespace dss
