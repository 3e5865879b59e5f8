/// Reactions of clamps against the loads that they balance.
#include "solver/model/energy.hpp"
#include "solver/model/reactions.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "tests/fixtures/problems.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace dss::test {
namespace {

constexpr Rotation all_equations[] = {Rotation::quaternion, Rotation::small, Rotation::linearised};

Reactions reactions_at(const Problem& problem, const std::vector<double>& state, Rotation equations,
                       double t) {
  const auto found = energy_and_reactions(problem, state, equations, signals_at(problem, t));
  EXPECT_EQ(found.energy_j, total_energy(problem, state, equations));
  return found.reactions.value();
}

Eigen::Vector3d vector_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// Links exert no force and no moment as a whole, in any state. So clamps that hold all elements
/// balance the loads and the inertia of the frame's acceleration.
TEST(Reactions, of_a_body_that_is_held_everywhere_balance_its_loads_in_any_state) {
  Problem problem = fixture::pressed(fixture::make_block(4, 3, 2, LinkLaw::material));
  problem.loads = {{{1, 7}, {3, -1, 2}, {0.1, 0, -0.2}, {}}, {{20}, {0, 4, 0}, {0, 0, 0}, {}}};
  problem.frame_acceleration[2].amplitude = -9.81;
  const std::vector<double> state = fixture::random_state(problem, 3, 1e-3, 0.02, 0.1);
  std::vector<Eigen::Vector3d> rest(problem.lattice.element_count);
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    rest[e] = vector_of(rest_position(problem, row, x));
    problem.clamps.push_back({e, dof_ux | dof_uy | dof_uz});
    problem.clamps.push_back({e, dof_rx | dof_ry | dof_rz});
  });
  for (const Rotation equations : all_equations) {
    const auto place = [&](std::size_t e) {
      const double* u = &state[e * field_count + ux];
      if (equations == Rotation::linearised) return rest[e];
      return Eigen::Vector3d(rest[e] + Eigen::Vector3d(u[0], u[1], u[2]));
    };
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
    const auto add = [&](std::size_t e, const Eigen::Vector3d& f, const Eigen::Vector3d& m) {
      force -= f;
      moment -= place(e).cross(f) + m;
    };
    for (const Load& load : problem.loads)
      for (const std::size_t e : load.elements)
        add(e, vector_of(load.force), vector_of(load.torque));
    for (std::size_t e = 0; e < rest.size(); ++e)
      add(e, {0, 0, -9.81 * problem.bodies[0].mass}, Eigen::Vector3d::Zero());
    const Reactions all = reactions_at(problem, state, equations, 0);
    EXPECT_LE((vector_of(all.force) - force).norm(), 1e-11 * force.norm()) << name(equations);
    EXPECT_LE((vector_of(all.moment) - moment).norm(), 1e-11 * force.norm()) << name(equations);
  }
}

TEST(Reactions, are_those_of_clamped_degrees_of_freedom_alone) {
  Problem problem = fixture::make_pair(LinkLaw::material, 0);
  problem.clamps = {{0, dof_ux}};
  std::vector<double> state(2 * field_count, 0.0);
  state[field_count + ux] = 1e-4, state[field_count + uy] = 2e-4;
  const double k = problem.bodies[0].axis[0].k_normal;
  const Reactions held = reactions_at(problem, state, Rotation::linearised, 0);
  EXPECT_NEAR(held.force[0], -k * 1e-4, 1e-12 * k);
  EXPECT_EQ(held.force[1], 0);
  const Vec3& edge = problem.bodies[0].edge; // the element's centre is at half of it
  EXPECT_NEAR(held.moment[1], edge[2] / 2 * held.force[0], 1e-13 * k);
  EXPECT_NEAR(held.moment[2], -edge[1] / 2 * held.force[0], 1e-13 * k);
}

} // namespace
} // namespace dss::test
