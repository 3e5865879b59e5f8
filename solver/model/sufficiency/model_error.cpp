#include "solver/model/sufficiency/model_error.hpp"
#include "solver/model/pressed_link.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dss {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

double squared(const double* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

/// Square of tan(angle / 2), which grows with the angle. Infinite from 180 degrees on.
double tangent_squared(const double* fields) {
  const double cosine = 1 + fields[qs];
  return cosine > 0 ? squared(fields + qx) / (cosine * cosine) : unbounded;
}

/// A link under the linear law.
struct LinearLink {
  double force2 = 0, energy = 0; ///< squared force [N^2], twice the elastic energy [J]
  double gap2 = 0, rate2 = 0;    ///< squared gap [m^2] and rate [m^2/s^2]
};

/// Opening of a link along `axis`, from displacements and small rotations [m] or from velocities
/// and spins [m/s].
std::array<double, 3> opening(const double* shift_i, const double* turn_i, const double* shift_j,
                              const double* turn_j, int axis, double arm_i, double arm_j) {
  const int b = (axis + 1) % 3, d = (axis + 2) % 3;
  // turn x c with c along `axis` is c turn_d along b and -c turn_b along d.
  return {shift_j[axis] - shift_i[axis],
          shift_j[b] - shift_i[b] - (arm_i * turn_i[d] + arm_j * turn_j[d]),
          shift_j[d] - shift_i[d] + (arm_i * turn_i[b] + arm_j * turn_j[b])};
}

LinearLink linear_link(const double* i, const double* j, int axis, LinkLaw law,
                       const AxisConstants& c, double arm_i, double arm_j) {
  const auto [along, b, d] =
      opening(i + ux, i + qx, j + ux, j + qx, axis, 2 * arm_i, 2 * arm_j); // theta = 2 q
  const auto rates = opening(i + vx, i + wx, j + vx, j + wx, axis, arm_i, arm_j);
  LinearLink link;
  const double across2 = b * b + d * d;
  link.gap2 = along * along + across2;
  link.rate2 = squared(rates.data());
  const double k_b = c.k_shear[std::size_t(axis + 1) % 3],
               k_d = c.k_shear[std::size_t(axis + 2) % 3];
  link.energy = c.k_normal * along * along + k_b * b * b + k_d * d * d;
  link.force2 = c.k_normal * c.k_normal * along * along + k_b * k_b * b * b + k_d * k_d * d * d;
  for (int m = 0; m < 3; ++m) {
    const double turn = 2 * (j[qx + m] - i[qx + m]);
    link.energy += c.k_rot[law == LinkLaw::paper ? 0 : std::size_t(m)] * turn * turn;
  }
  return link;
}

} // namespace

ModelErrorBound::ModelErrorBound(const Problem& problem, Model model)
    : problem_(problem), model_(model), structure_(bound_structure(problem)) {
  if (!needs_links()) return;
  body_of_.resize(problem.lattice.element_count);
  problem.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int) { body_of_[e] = row.body; });
}

void ModelErrorBound::look(std::span<const double> state, double time) {
  KindBounds now{};
  double tangent2 = 0;
  for (std::size_t e = 0; e < state.size(); e += field_count) {
    const double* fields = state.data() + e;
    const KindBounds own{squared(fields + ux), squared(fields + qx), squared(fields + vx),
                         squared(fields + wx)};
    for (std::size_t kind = 0; kind < now.size(); ++kind)
      now[kind] = std::max(now[kind], own[kind]);
    tangent2 = std::max(tangent2, tangent_squared(fields));
  }
  for (double& of_kind : now) of_kind = std::sqrt(of_kind);
  for (std::size_t kind = 0; kind < now.size(); ++kind)
    largest_[kind] = std::max(largest_[kind], now[kind]);
  rotation_ =
      std::max(rotation_, tangent2 < unbounded ? 2 * std::atan(std::sqrt(tangent2)) : 2 * M_PI);
  spin_ = now[3];
  if (!has_begun_) start_ = time_ = time;
  has_begun_ = true;
  double frequency = 0;
  if (largest_[0] > 0) frequency = now[2] / largest_[0];
  if (largest_[1] > 0) frequency = std::max(frequency, now[3] / (2 * largest_[1]));
  cycles_ += frequency * (time - time_);
  time_ = time;
  if (needs_links()) look_at_links(state);
}

/// Pressure of each element under the linear law [Pa]; empty if none has.
std::vector<double> ModelErrorBound::pressures_of(std::span<const double> state) const {
  if (!problem_.has_pressure()) return {};
  std::vector<double> pressures(body_of_.size());
  const auto body = [&](std::size_t e) -> const Body& {
    return problem_.bodies[std::size_t(body_of_[e])];
  };
  problem_.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    const auto at = [&](std::size_t e) { return state[e * field_count + std::size_t(ux + axis)]; };
    const double strain = (at(j) - at(i)) / body(i).edge[std::size_t(axis)];
    pressures[i] += strain / 2, pressures[j] += strain / 2;
  });
  for (const Load& load : problem_.loads)
    for (const std::size_t e : load.elements) pressures[e] += load.face_strain * load.signal(time_);
  for (std::size_t e = 0; e < pressures.size(); ++e)
    pressures[e] *= problem_.pressure(e, body(e)).volume;
  return pressures;
}

void ModelErrorBound::look_at_links(std::span<const double> state) {
  const std::vector<double> pressures = pressures_of(state);
  double force2 = 0, gap2 = 0, rate2 = 0, strain_energy = 0, arms_energy = 0;
  const auto add = [&](std::size_t e, std::size_t f, int axis, LinkLaw law, const AxisConstants& c,
                       double pressed, double pressed_stiffness) {
    const double *i = state.data() + e * field_count, *j = state.data() + f * field_count;
    const auto a = std::size_t(axis);
    const double arm_i = problem_.bodies[std::size_t(body_of_[e])].edge[a] / 2,
                 arm_j = problem_.bodies[std::size_t(body_of_[f])].edge[a] / 2;
    const LinearLink link = linear_link(i, j, axis, law, c, arm_i, arm_j);
    const double force = std::sqrt(link.force2) + pressed;
    force2 = std::max(force2, force * force);
    gap2 = std::max(gap2, link.gap2);
    rate2 = std::max(rate2, link.rate2);
    strain_energy += link.energy;
    // An arm turned by t is too long by the fraction t^2 / 2, and t <= 2 tan(t / 2).
    const double longer = 2 * (arm_i * tangent_squared(i) + arm_j * tangent_squared(j));
    arms_energy += (c.k_normal + pressed_stiffness) * longer * longer;
  };
  problem_.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    const Body& body = problem_.bodies[std::size_t(body_of_[i])];
    const auto a = std::size_t(axis);
    const double half_area = body.edge[(a + 1) % 3] * body.edge[(a + 2) % 3] / 2;
    const double pressed =
        pressures.empty() ? 0 : half_area * std::abs(pressures[i] + pressures[j]);
    add(i, j, axis, body.law, body.link(axis, problem_.link_kind(i, axis)), pressed,
        largest_pressed_link(body, axis).normal);
  });
  for (const ExtraLink& link : problem_.extra_links)
    add(link.i, link.j, link.axis, link.law, link.constants, 0, 0);
  force_ = std::max(force_, std::sqrt(force2));
  gap_ = std::max(gap_, std::sqrt(gap2));
  rate_ = std::max(rate_, std::sqrt(rate2));
  strain_energy_ = std::max(strain_energy_, strain_energy);
  arms_energy_ = std::max(arms_energy_, arms_energy);
}

/// Relative error of the stiffness that the motion feels, without the forces on turned links.
/// @param growth  predicted rotation over the rotation at the last look
double ModelErrorBound::operator_error(double rotation, double growth) const {
  if (structure_.is_flat) return 4 * rotation * rotation;
  const double of_arms = structure_.is_tree || arms_energy_ == 0
                             ? 0
                             : growth * growth * std::sqrt(arms_energy_ / strain_energy_);
  return rotation + of_arms +
         (model_ == Model::small ? 0 : growth * gap_ / structure_.shortest_edge);
}

/// Errors from forces that should turn with links but do not: all forces of the model, or the
/// forces that arms of wrong length cause.
KindBounds ModelErrorBound::turned_forces(double rotation, double growth, double time) const {
  double force =
      structure_.is_tree ? 0 : structure_.stiffness * structure_.edge * rotation * rotation / 2;
  if (model_ != Model::small && !structure_.is_flat) force += force_ * growth;
  if (force == 0) return {};
  // First bound: a change of stiffness compared with the buckling load.
  const double load = structure_.is_held ? force / structure_.least_buckling : unbounded;
  const double amplified = load < 0.5 ? load / (1 - load) * (1 + cycles_) : unbounded;
  // Second bound: forces that push elements without any resistance, six links each.
  const double push = 6 * force * rotation / structure_.mass,
               twist = 6 * force * rotation * structure_.edge / structure_.inertia;
  const double rate = std::sqrt(6 * force *
                                std::max(1 / (structure_.shortest_edge * structure_.mass),
                                         structure_.edge / structure_.inertia));
  // The limit 700 avoids overflow; such an error exceeds every bound anyway.
  const double feedback = std::cosh(std::min(rate * time, 700.0));
  KindBounds errors{push * time * time / 2, twist * time * time / 4, push * time, twist * time};
  for (std::size_t kind = 0; kind < errors.size(); ++kind)
    errors[kind] = std::min(errors[kind] * feedback,
                            largest_[kind] > 0 ? amplified * largest_[kind] : unbounded);
  return errors;
}

KindBounds ModelErrorBound::errors(double ahead) const {
  const double theta = rotation_ + spin_ * ahead, growth = rotation_ > 0 ? theta / rotation_ : 1;
  if (theta == 0 && gap_ == 0) return {};
  const double longer = theta * theta / 2; // relative excess length of an arm
  const auto [u, q, v, w] = largest_;
  KindBounds errors{longer * structure_.length, theta * theta / 4, theta * w * structure_.length,
                    theta * w};
  const KindBounds turned = turned_forces(theta, growth, time_ + ahead - start_);
  const double edge = structure_.shortest_edge;
  // Without products, couples of gaps are left out. They act even before anything turns.
  const bool has_products = model_ == Model::small;
  const KindBounds scales{u, has_products ? q : std::max(q, gap_ / edge), v,
                          has_products ? w : std::max(w, rate_ / edge)};
  const double stiffness = operator_error(theta, growth) * (1 + cycles_);
  for (std::size_t kind = 0; kind < errors.size(); ++kind)
    errors[kind] += turned[kind] + stiffness * scales[kind];
  return errors;
}

} // namespace dss
