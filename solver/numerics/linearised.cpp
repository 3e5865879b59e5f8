#include "solver/numerics/linearised.hpp"

#include <algorithm>
#include <limits>

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
LinkMatrices link_matrices(int axis, const AxisConstants& constants, const Vec3& edge_i,
                           const Vec3& edge_j) {
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
  return {strain.transpose() * k.asDiagonal() * strain,
          strain.transpose() * c.asDiagonal() * strain, least_ratio(c, k)};
}

} // namespace

Linearised::Linearised(const Problem& problem)
    : body(problem.lattice.element_count), clamped(problem.lattice.element_count) {
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) { body[e] = row.body; });
  for (const Clamp& clamp : problem.clamps) clamped[clamp.element] |= clamp.dofs;
  std::vector<std::size_t> first_kind; // of each body
  for (const Body& b : problem.bodies) {
    Vector6 inertia;
    inertia << b.mass, b.mass, b.mass, b.inertia[0], b.inertia[1], b.inertia[2];
    inverse_inertia.push_back(inertia.cwiseInverse());
    first_kind.push_back(kinds.size());
    b.each_kind([&](const AxisConstants& constants, int axis) {
      kinds.push_back(link_matrices(axis, constants, b.edge, b.edge));
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
  const Stabilization& tie = problem.stabilization;
  tie_stiffness << tie.k, tie.k, tie.k, tie.k_rot, tie.k_rot, tie.k_rot;
  tie_damping << tie.d, tie.d, tie.d, tie.d_rot, tie.d_rot, tie.d_rot;
}

Vector6 Linearised::free_inverse_inertia(std::size_t element) const {
  Vector6 inverse = inverse_inertia[std::size_t(body[element])];
  for (int dof = 0; dof < 6; ++dof)
    if (clamped[element] >> dof & 1) inverse[dof] = 0;
  return inverse;
}

} // namespace dss
