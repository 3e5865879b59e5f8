#include "solver/numerics/linearised.hpp"

#include "solver/model/pressed_link.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace dss {
namespace {

Eigen::Matrix3d arm_matrix(int axis, const Vec3& edge) {
  const Eigen::Vector3d arm = Eigen::Vector3d::Unit(axis) * edge[std::size_t(axis)] / 2;
  Eigen::Matrix3d m;
  m << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  return m;
}

/// Smallest ratio of a damper to the spring beside it [s]; infinite without springs.
double least_ratio(const Vector6& damping, const Vector6& stiffness) {
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 6; ++n)
    if (stiffness[n] > 0) least = std::min(least, damping[n] / stiffness[n]);
  return least;
}

/// Both laws are the same to first order: gap = u_j - u_i + c_i x theta_i + c_j x theta_j,
/// turn = theta_j - theta_i.
/// @param most  of the pressures of its elements
LinkMatrices link_matrices(int axis, const AxisConstants& constants, const Vec3& edge_i,
                           const Vec3& edge_j, const PressedLink& most = {}) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), none = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 6, 12> strain;
  strain << -one, arm_matrix(axis, edge_i), one, arm_matrix(axis, edge_j), none, -one, none, one;
  const auto diagonal = [axis](double normal, const Vec3& shear, const Vec3& rot) {
    Vector6 d;
    d << shear[0], shear[1], shear[2], rot[0], rot[1], rot[2];
    d[axis] = normal;
    return d;
  };
  const Vector6 k = diagonal(constants.k_normal, constants.k_shear, constants.k_rot);
  const Vector6 c = diagonal(constants.d_normal, constants.d_shear, constants.d_rot);
  Vector6 bound = k;
  bound[axis] += most.normal;
  for (int m = 0; m < 3; ++m) bound[3 + m] += most.turn[std::size_t(m)];
  const auto matrix = [&](const Vector6& of) {
    return Matrix12(strain.transpose() * of.asDiagonal() * strain);
  };
  return {matrix(k), matrix(c), least_ratio(c, bound), matrix(bound)};
}

/// Terms of elements with a pressure, whose parts are added link by link.
class PressureTerms {
public:
  /// @param which  0: the volume strain; 1 + o: the curvatures about the normal o
  void add_term(std::size_t e, int which, double weight) {
    if (weight == 0) return;
    index_[{e, which}] = terms_.size();
    terms_.push_back({weight, {}});
  }
  void add_link(std::size_t i, std::size_t j, int axis, double length) {
    for (const std::size_t e : {i, j}) {
      add(e, 0, i, j, axis, 1 / (2 * length));
      for (int o = 0; o < 3; ++o)
        if (o != axis)
          add(e, 1 + o, i, j, 3 + (3 - o - axis), ((o + 1) % 3 == axis ? 1 : -1) / (2 * length));
    }
  }
  /// The terms; parts with the same degree of freedom are added up.
  std::vector<PressureTerm> finished() {
    for (PressureTerm& term : terms_) {
      std::ranges::stable_sort(term.parts, {}, &PressureTerm::Part::dof);
      std::vector<PressureTerm::Part> sums;
      for (const PressureTerm::Part& part : term.parts)
        if (!sums.empty() && sums.back().dof == part.dof)
          sums.back().coefficient += part.coefficient;
        else
          sums.push_back(part);
      std::erase_if(sums, [](const PressureTerm::Part& part) { return part.coefficient == 0; });
      term.parts = std::move(sums);
    }
    return std::move(terms_);
  }

private:
  void add(std::size_t e, int which, std::size_t i, std::size_t j, int dof, double coefficient) {
    const auto found = index_.find({e, which});
    if (found == index_.end()) return;
    std::vector<PressureTerm::Part>& parts = terms_[found->second].parts;
    parts.push_back({6 * i + std::size_t(dof), -coefficient});
    parts.push_back({6 * j + std::size_t(dof), coefficient});
  }
  std::map<std::pair<std::size_t, int>, std::size_t> index_;
  std::vector<PressureTerm> terms_;
};

std::vector<PressureTerm> pressure_terms(const Problem& problem, const std::vector<int>& body) {
  if (!problem.has_pressure()) return {};
  const auto body_of = [&](std::size_t e) -> const Body& {
    return problem.bodies[std::size_t(body[e])];
  };
  PressureTerms terms;
  for (std::size_t e = 0; e < body.size(); ++e) {
    const Vec3& edge = body_of(e).edge;
    const double volume = edge[0] * edge[1] * edge[2];
    const ElementPressure own = problem.pressure(e, body_of(e));
    terms.add_term(e, 0, volume * own.volume);
    for (int o = 0; o < 3; ++o) terms.add_term(e, 1 + o, volume * own.bending[std::size_t(o)]);
  }
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    if (!body_of(i).pressures.empty())
      terms.add_link(i, j, axis, body_of(i).edge[std::size_t(axis)]);
  });
  return terms.finished();
}

} // namespace

Linearised::Linearised(const Problem& problem)
    : body(problem.lattice.element_count), clamped(problem.lattice.element_count) {
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) { body[e] = row.body; });
  for (std::size_t e = 0; e < body.size() && problem.has_mass_ratios(); ++e)
    mass_ratio.push_back(problem.mass_ratio(e, problem.bodies[std::size_t(body[e])]));
  for (const Clamp& clamp : problem.clamps) clamped[clamp.element] |= clamp.dofs;
  std::vector<std::size_t> first_kind; // of each body
  for (const Body& b : problem.bodies) {
    Vector6 inertia;
    inertia << b.mass, b.mass, b.mass, b.inertia[0], b.inertia[1], b.inertia[2];
    inverse_inertia.push_back(inertia.cwiseInverse());
    first_kind.push_back(kinds.size());
    b.each_kind([&](const AxisConstants& constants, int axis) {
      kinds.push_back(
          link_matrices(axis, constants, b.edge, b.edge, largest_pressed_link(b, axis)));
    });
  }
  const auto add = [&](std::size_t i, std::size_t j, std::size_t kind) {
    links.push_back({i, j, kind});
  };
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    add(i, j,
        first_kind[std::size_t(body[i])] + 3 * problem.link_kind(i, axis) + std::size_t(axis));
  });
  for (const ExtraLink& extra : problem.extra_links) {
    add(extra.i, extra.j, kinds.size());
    kinds.push_back(link_matrices(extra.axis, extra.constants,
                                  problem.bodies[std::size_t(body[extra.i])].edge,
                                  problem.bodies[std::size_t(body[extra.j])].edge));
  }
  pressures = pressure_terms(problem, body);
  const Stabilization& tie = problem.stabilization;
  tie_stiffness << tie.k, tie.k, tie.k, tie.k_rot, tie.k_rot, tie.k_rot;
  tie_damping << tie.d, tie.d, tie.d, tie.d_rot, tie.d_rot, tie.d_rot;
}

Vector6 Linearised::free_inverse_inertia(std::size_t element) const {
  Vector6 inverse = inverse_inertia[std::size_t(body[element])];
  if (!mass_ratio.empty()) inverse /= mass_ratio[element];
  for (int dof = 0; dof < 6; ++dof)
    if (clamped[element] >> dof & 1) inverse[dof] = 0;
  return inverse;
}

} // namespace dss
