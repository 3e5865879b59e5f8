/// The matrices of a static system.
#include "solver/numerics/linearised.hpp"
#include "solver/statics/static_system.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace dss {
namespace {

using Real = StaticSystem::Real;
using Motion = reference::Motion<Real>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr Real angle_step = 1e-6L; // step of differences [rad]

/// Adds the lower half of a matrix that couples the degrees of freedom `dof` (6 element + 0 .. 5).
/// Exact zeros are left out.
template <class Matrix>
void add_block(const FreeDofs& dofs,
               const std::array<std::size_t, std::size_t(Matrix::RowsAtCompileTime)>& dof,
               const Matrix& block, Triplets& entries) {
  for (std::size_t r = 0; r < dof.size(); ++r)
    for (std::size_t c = 0; c < dof.size(); ++c) {
      const Eigen::Index row = dofs.index[dof[r]], column = dofs.index[dof[c]];
      const double value = block(Eigen::Index(r), Eigen::Index(c));
      if (row >= column && column >= 0 && value != 0)
        entries.emplace_back(int(row), int(column), value);
    }
}

std::array<std::size_t, 12> dofs_of_link(std::size_t i, std::size_t j) {
  std::array<std::size_t, 12> dof;
  for (std::size_t d = 0; d < 6; ++d) dof[d] = 6 * i + d, dof[6 + d] = 6 * j + d;
  return dof;
}
template <std::size_t first, std::size_t count>
std::array<std::size_t, count> dofs_of_element(std::size_t e) {
  std::array<std::size_t, count> dof;
  for (std::size_t d = 0; d < count; ++d) dof[d] = 6 * e + first + d;
  return dof;
}

/// Adds the lower half of a term's matrix.
void add_term(const FreeDofs& dofs, const PressureTerm& term, Triplets& entries) {
  for (const auto& [row_dof, a] : term.parts)
    for (const auto& [column_dof, b] : term.parts) {
      const Eigen::Index row = dofs.index[row_dof], column = dofs.index[column_dof];
      if (row >= column && column >= 0)
        entries.emplace_back(int(row), int(column), term.weight * a * b);
    }
}

SparseMatrix assembled(const Triplets& entries, Eigen::Index size) {
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

} // namespace

SparseMatrix StaticSystem::stiffness_at_rest() const {
  const Linearised system(problem_);
  Triplets entries;
  for (const auto& [i, j, kind] : system.links)
    add_block(dofs_, dofs_of_link(i, j), system.kinds[kind].k, entries);
  for (const PressureTerm& term : system.pressures) add_term(dofs_, term, entries);
  const Matrix6 tie = system.tie_stiffness.asDiagonal();
  if (problem_.stabilization.is_present())
    for (std::size_t e = 0; e < body_.size(); ++e)
      add_block(dofs_, dofs_of_element<0, 6>(e), tie, entries);
  return assembled(entries, size());
}

/// Derivative of `value`, a column of numbers that depend on the motions of a link's elements, by
/// the displacements of the two and their turns about axes in space, by central differences.
/// Columns of degrees of freedom that do not move are zero.
template <class Value>
auto StaticSystem::link_slope(const Link& link, const State& state, Value&& value) const {
  const Motion at[2] = {dynamics_.placed(link.i, &state[link.i * field_count]),
                        dynamics_.placed(link.j, &state[link.j * field_count])};
  const auto moved_value = [&](std::size_t dof, Real by) {
    const std::size_t end = dof / 6, e = end == 0 ? link.i : link.j;
    std::array<Real, field_count> fields;
    std::copy_n(&state[e * field_count], fields.size(), fields.begin());
    if (dof % 6 < 3)
      fields[ux + dof % 6] += by;
    else
      turn_fields(fields.data(), by * reference::Vector<Real>::Unit(Eigen::Index(dof % 6 - 3)));
    const Motion moved = dynamics_.placed(e, fields.data());
    return end == 0 ? value(moved, at[1]) : value(at[0], moved);
  };
  using Column = decltype(value(at[0], at[1]));
  const auto dofs = dofs_of_link(link.i, link.j);
  Eigen::Matrix<Real, Column::RowsAtCompileTime, 12> slope;
  slope.setZero();
  for (std::size_t d = 0; d < 12; ++d) {
    if (dofs_.index[dofs[d]] < 0) continue;
    const Real step = d % 6 < 3 ? angle_step * Real(edge_) : angle_step;
    slope.col(Eigen::Index(d)) = (moved_value(d, step) - moved_value(d, -step)) / (2 * step);
  }
  return slope;
}

/// Stiffness of a link: minus the derivative of its reactions.
/// @param pressure  that acts on it, or null
Matrix12 StaticSystem::link_stiffness(const Link& link, const State& state,
                                      const reference::LinkPressure<Real>* pressure) const {
  const auto slope = link_slope(link, state, [&](const Motion& i, const Motion& j) {
    reference::Reaction<Real> r = dynamics_.link_reaction(i, j, link);
    if (pressure != nullptr) {
      const auto more = dynamics_.pressure_reaction_of(i, j, link, *pressure);
      r.force += more.force, r.moment_i += more.moment_i, r.moment_j += more.moment_j;
    }
    Eigen::Matrix<Real, 12, 1> forces;
    forces << r.force, r.moment_i, -r.force, r.moment_j;
    return forces;
  });
  return Matrix12(-slope.template cast<double>());
}

/// The strain of an element in the present state as a function of its neighbours' motions.
std::vector<PressureTerm> StaticSystem::pressure_terms(const State& state) const {
  constexpr std::size_t kinds = 4; // volume; curvatures about three normals
  std::vector<std::array<std::map<std::size_t, double>, kinds>> slopes(body_.size());
  for (const Link& link : dynamics_.links()) {
    if (!dynamics_.has_pressure(link)) continue;
    const auto slope = link_slope(link, state, [&](const Motion& i, const Motion& j) {
      reference::ElementStrain<Real> strain;
      dynamics_.add_strain(link, dynamics_.strain(i, j, link), strain);
      return Eigen::Matrix<Real, 4, 1>(strain.volume, strain.curvature[0], strain.curvature[1],
                                       strain.curvature[2]);
    });
    const auto dofs = dofs_of_link(link.i, link.j);
    for (const std::size_t e : {link.i, link.j})
      for (std::size_t kind = 0; kind < kinds; ++kind)
        for (std::size_t d = 0; d < dofs.size(); ++d)
          if (const Real own = slope(Eigen::Index(kind), Eigen::Index(d)); own != 0)
            slopes[e][kind][dofs[d]] += double(own);
  }
  std::vector<PressureTerm> terms;
  for (std::size_t e = 0; e < body_.size(); ++e) {
    const auto unit = dynamics_.resistance(e, {1, reference::Vector<Real>::Ones()});
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const Real constant = kind == 0 ? unit.volume : unit.curvature[Eigen::Index(kind - 1)];
      if (constant == 0) continue;
      PressureTerm& term = terms.emplace_back();
      term.weight = double(constant * dynamics_.volume(e));
      for (const auto& [dof, slope] : slopes[e][kind]) term.parts.push_back({dof, slope});
    }
  }
  return terms;
}

SparseMatrix StaticSystem::tangent(const State& state) const {
  Triplets entries;
  const auto strains = dynamics_.strains(state, signals_);
  if (dynamics_.has_pressure())
    for (const PressureTerm& term : pressure_terms(state)) add_term(dofs_, term, entries);
  for (const Link& link : dynamics_.links()) {
    const bool has_pressure = dynamics_.has_pressure(link);
    reference::LinkPressure<Real> pressure;
    if (has_pressure)
      pressure = dynamics_.pressure_on(link, dynamics_.resistance(link.i, strains[link.i]),
                                       dynamics_.resistance(link.j, strains[link.j]));
    const Matrix12 slope = link_stiffness(link, state, has_pressure ? &pressure : nullptr);
    add_block(dofs_, dofs_of_link(link.i, link.j), Matrix12((slope + slope.transpose()) / 2),
              entries);
  }
  const Stabilization& tie = problem_.stabilization;
  for (std::size_t e = 0; e < body_.size() && (tie.k != 0 || tie.k_rot != 0); ++e) {
    const bool has_vectors = dynamics_.coordinates().has_vectors();
    const double scalar = has_vectors ? 1 : double(1 + state[e * field_count + qs]);
    // Slope of the moment -2 k_rot v(q) over a turn; its symmetric part is q0 k_rot.
    Vector6 diagonal;
    diagonal << tie.k, tie.k, tie.k, Eigen::Vector3d::Constant(tie.k_rot * scalar);
    add_block(dofs_, dofs_of_element<0, 6>(e), Matrix6(diagonal.asDiagonal()), entries);
  }
  return assembled(entries, size());
}

SparseMatrix StaticSystem::mass(const State& state) const {
  Triplets entries;
  for (std::size_t e = 0; e < body_.size(); ++e) {
    const Body& body = problem_.bodies[std::size_t(body_[e])];
    const double ratio = problem_.mass_ratio(e, body);
    const Eigen::Vector3d own =
        ratio * Eigen::Vector3d(body.inertia[0], body.inertia[1], body.inertia[2]);
    add_block(dofs_, dofs_of_element<0, 3>(e),
              Eigen::Matrix3d(Eigen::Matrix3d::Identity() * (ratio * body.mass)), entries);
    Eigen::Matrix3d inertia = own.asDiagonal();
    if (body.has_tensor_inertia() && !dynamics_.coordinates().has_vectors()) {
      const Eigen::Matrix3d axes =
          dynamics_.placed(e, &state[e * field_count]).rotation().cast<double>();
      inertia = axes * own.asDiagonal() * axes.transpose();
    }
    add_block(dofs_, dofs_of_element<3, 3>(e), inertia, entries);
  }
  return assembled(entries, size());
}

} // namespace dss
