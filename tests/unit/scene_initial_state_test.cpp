#include "tests/fixtures/problems.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

namespace dss {
namespace {

InitialMotion rigid_motion(const Problem& problem) {
  InitialMotion motion;
  for (std::size_t e = 0; e < problem.lattice.element_count; ++e) motion.elements.push_back(e);
  motion.displacement = {0.1, 0.2, -0.3};
  motion.rotation = {0.4, -1.1, 0.7};
  motion.velocity = {1, 2, 3};
  motion.angular_velocity = {0.5, -2, 1};
  motion.is_rigid = true;
  motion.centre = {0.05, 0.4, -0.1};
  return motion;
}

Problem block_with_a_hole() {
  Problem problem = fixture::empty_problem("hole");
  append_body(problem.lattice, {4, 2, 1, {1, 0, 1, 1, 1, 1, 1, 1}}, 0);
  problem.bodies.push_back(fixture::soft_body(LinkLaw::material));
  return problem;
}

TEST(initial_state, is_all_zeros_without_a_motion) {
  const Problem problem = fixture::make_pair(LinkLaw::paper);
  std::vector<double> state(problem.lattice.element_count * field_count, NAN);
  initial_state(problem, 0, problem.lattice.element_count, state.data());
  for (const double field : state) EXPECT_EQ(field, 0);
  EXPECT_EQ(initial_state(problem), state);
}

TEST(initial_state, of_a_rigid_motion_is_the_rotation_about_its_centre) {
  Problem problem = fixture::make_block(3, 2, 2, LinkLaw::material);
  const InitialMotion motion = rigid_motion(problem);
  problem.initial_motions = {motion};
  const std::vector<double> state = initial_state(problem);
  const Eigen::Vector3d axis(motion.rotation.data()), centre(motion.centre.data()),
      w(motion.angular_velocity.data());
  const Eigen::AngleAxisd turn(axis.norm(), axis.normalized());
  const Eigen::Quaterniond q(turn);
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const double* f = &state[e * field_count];
    const Vec3 rest = rest_position(problem, row, x);
    const Eigen::Vector3d X(rest.data()),
        now = turn * (X - centre) + centre + Eigen::Vector3d(motion.displacement.data());
    const Eigen::Vector3d v = Eigen::Vector3d(motion.velocity.data()) + w.cross(now - centre);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(f[ux + a], (now - X)[a], 1e-15);
      EXPECT_NEAR(f[vx + a], v[a], 1e-14);
      EXPECT_NEAR(f[qx + a], q.vec()[a], 1e-15);
      EXPECT_EQ(f[wx + a], w[a]);
    }
    EXPECT_NEAR(f[qs], q.w() - 1, 1e-15);
  });
}

TEST(initial_state, keeps_all_digits_of_a_tiny_rotation) {
  Problem problem = fixture::make_pair(LinkLaw::paper);
  InitialMotion motion;
  motion.elements = {1};
  motion.rotation = {0, 0, 2e-6};
  problem.initial_motions = {motion};
  const std::vector<double> state = initial_state(problem);
  EXPECT_NEAR(state[field_count + qs] / -5e-13, 1,
              1e-12); // cos(1e-6) - 1 in doubles has four digits
  EXPECT_NEAR(state[field_count + qz] / 1e-6, 1, 1e-12);
}

TEST(initial_state, of_a_part_equals_that_part_of_the_whole) {
  Problem problem = block_with_a_hole();
  problem.initial_motions = {rigid_motion(problem)};
  const std::vector<double> whole = initial_state(problem);
  std::vector<double> part(4 * field_count, NAN);
  initial_state(problem, 3, 4, part.data());
  for (std::size_t k = 0; k < part.size(); ++k) EXPECT_EQ(part[k], whole[3 * field_count + k]);
}

TEST(initial_state, of_two_motions_in_turn_composes_them) {
  Problem problem = fixture::make_pair(LinkLaw::paper);
  InitialMotion first, second;
  first.elements = second.elements = {0, 1};
  first.rotation = {0.3, 0, 0};
  second.rotation = {0, 0.5, 0};
  first.velocity = {1, 0, 0};
  second.velocity = {0, 2, 0};
  problem.initial_motions = {first, second};
  const std::vector<double> state = initial_state(problem);
  const Eigen::Quaterniond q = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()) * //
                               Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  EXPECT_NEAR(state[qs], q.w() - 1, 1e-15);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(state[std::size_t(qx + a)], q.vec()[a], 1e-15);
  EXPECT_EQ(state[vx], 1);
  EXPECT_EQ(state[vy], 2);
}

} // namespace
} // namespace dss
