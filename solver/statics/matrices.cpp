/// The matrices of a static system.
#include "solver/numerics/linearised.hpp"
#include "solver/statics/static_system.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace dss {
namespace {

using Real = StaticSystem::Real;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Adds the lower half of a matrix that couples the degrees of freedom `dof` (6 element + 0 .. 5).
/// @param has_zeros  false: exact zeros are left out
template <class Matrix>
void add_block(const FreeDofs& dofs,
               const std::array<std::size_t, std::size_t(Matrix::RowsAtCompileTime)>& dof,
               const Matrix& block, Triplets& entries, bool has_zeros = false) {
  for (std::size_t r = 0; r < dof.size(); ++r)
    for (std::size_t c = 0; c < dof.size(); ++c) {
      const Eigen::Index row = dofs.index[dof[r]], column = dofs.index[dof[c]];
      const double value = block(Eigen::Index(r), Eigen::Index(c));
      if (row >= column && column >= 0 && (value != 0 || has_zeros))
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

/// Adds what ties every element to the frame.
void add_ties(const FreeDofs& dofs, const Vector6& tie, Triplets& entries) {
  for (Eigen::Index n = 0; n < dofs.size(); ++n)
    if (const double value = tie[Eigen::Index(dofs.dof[std::size_t(n)] % 6)]; value != 0)
      entries.emplace_back(int(n), int(n), value);
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
  add_ties(dofs_, system.tie_stiffness, entries);
  return assembled(entries, size());
}

SparseMatrix StaticSystem::damping_at_rest() const {
  const Linearised system(problem_);
  Triplets entries;
  for (const auto& [i, j, kind] : system.links)
    add_block(dofs_, dofs_of_link(i, j), system.kinds[kind].c, entries);
  add_ties(dofs_, system.tie_damping, entries);
  return assembled(entries, size());
}

reference::MovingLink StaticSystem::moving_link(const Link& link, const State& state) const {
  const auto placed = [&](std::size_t e) {
    return reference::cast<double>(dynamics_.placed(e, &state[e * field_count]));
  };
  return {dynamics_.coordinates().rotation(), placed(link.i), placed(link.j),
          reference::cast<double>(dynamics_.properties(link))};
}

/// The strain of an element in the present state as a function of its neighbours' motions.
std::vector<PressureTerm> StaticSystem::pressure_terms(const State& state) const {
  constexpr std::size_t kinds = 4; // volume; curvatures about three normals
  std::vector<std::array<std::map<std::size_t, double>, kinds>> slopes(body_.size());
  for (const Link& link : dynamics_.links()) {
    if (!dynamics_.has_pressure(link)) continue;
    const auto slope = reference::strain_slope(moving_link(link, state), {});
    const auto dofs = dofs_of_link(link.i, link.j);
    for (const std::size_t e : {link.i, link.j})
      for (std::size_t kind = 0; kind < kinds; ++kind)
        for (std::size_t d = 0; d < dofs.size(); ++d)
          if (const double own = slope(Eigen::Index(kind), Eigen::Index(d)); own != 0)
            slopes[e][kind][dofs[d]] += own;
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

SparseMatrix StaticSystem::tangent(const State& state,
                                   const reference::Variation& variation) const {
  Triplets entries;
  const auto strains = dynamics_.strains(state, signals_);
  if (dynamics_.has_pressure())
    for (PressureTerm& term : pressure_terms(state)) {
      term.weight *= variation.moved;
      add_term(dofs_, term, entries);
    }
  for (const Link& link : dynamics_.links()) {
    const bool has_pressure = dynamics_.has_pressure(link);
    reference::LinkPressure<double> pressure;
    if (has_pressure)
      pressure = reference::cast<double>(
          dynamics_.pressure_on(link, dynamics_.resistance(link.i, strains[link.i]),
                                dynamics_.resistance(link.j, strains[link.j])));
    const Matrix12 slope = reference::reaction_slope(moving_link(link, state),
                                                     has_pressure ? &pressure : nullptr, variation);
    // Zeros come and go with the state. With them all tangents have one order of elimination.
    add_block(dofs_, dofs_of_link(link.i, link.j), Matrix12(-(slope + slope.transpose()) / 2),
              entries, true);
  }
  const Stabilization& tie = problem_.stabilization;
  for (std::size_t e = 0; e < body_.size() && tie.is_present(); ++e) {
    const bool has_vectors = dynamics_.coordinates().has_vectors();
    const double scalar = has_vectors ? 1 : double(1 + state[e * field_count + qs]);
    // Slope of the moment -2 k_rot v(q) over a turn; its symmetric part is q0 k_rot.
    Vector6 diagonal;
    diagonal << Eigen::Vector3d::Constant(variation.moved * tie.k + variation.sped * tie.d),
        Eigen::Vector3d::Constant(variation.moved * tie.k_rot * scalar +
                                  variation.sped * tie.d_rot);
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
