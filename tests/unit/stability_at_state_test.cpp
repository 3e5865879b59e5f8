#include "solver/numerics/stability_at_state.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dss {
namespace {

/// Largest eigenvalue of a clamped pair of elements that is pulled apart by `gap` along its axis:
/// shear and turn of the free element, by the energy k/2 D.D + 2 kt (1 - cos(theta)) with
/// D = (gap + a (1 - cos(theta)), u - a sin(theta)), a half an edge.
double largest_eigenvalue(const Body& body, double gap) {
  const AxisConstants& c = body.axis[0];
  const double a = body.edge[0] / 2, k = c.k_normal, m = body.mass;
  // Turns about y and z have moments of inertia of their own; the smaller one is faster.
  const double inertia = std::min(body.inertia[1], body.inertia[2]);
  const double shear = k / m, turn = (k * a * (a + gap) + c.k_rot[0]) / inertia;
  const double coupling = k * a * k * a / (m * inertia);
  return (shear + turn) / 2 + std::sqrt((shear - turn) * (shear - turn) / 4 + coupling);
}

TEST(StableStepAtState, is_that_of_rest_at_rest) {
  const Problem problem = fixture::make_everything();
  EXPECT_NEAR(stable_step_at_state(problem, Rotation::quaternion, fixture::rest(problem), 1), 1,
              1e-6);
}

TEST(StableStepAtState, falls_as_the_square_root_of_the_stiffness_of_a_stretched_pair) {
  Problem pair = fixture::make_pair(LinkLaw::paper, 0);
  pair.clamps = {{0, dof_all}};
  for (const double gap : {0.02, 0.1, 0.5}) {
    std::vector<double> state = fixture::rest(pair);
    state[field_count + ux] = gap;
    state[field_count + vy] = 7; // velocities change nothing
    const double expected =
        std::sqrt(largest_eigenvalue(pair.bodies[0], 0) / largest_eigenvalue(pair.bodies[0], gap));
    EXPECT_NEAR(stable_step_at_state(pair, Rotation::quaternion, state, 2), 2 * expected,
                1e-3 * expected)
        << gap;
    EXPECT_LT(expected, 0.99);
  }
}

TEST(StableStepAtState, of_a_body_that_is_stretched_falls_and_with_small_rotations_does_not) {
  const Problem block = fixture::make_block(6, 3, 2, LinkLaw::paper, 0);
  std::vector<double> state = fixture::rest(block);
  block.lattice.for_each_element([&](std::size_t e, const Row&, int x) {
    state[e * field_count + ux] = 0.5 * block.bodies[0].edge[0] * double(x);
  });
  EXPECT_LT(stable_step_at_state(block, Rotation::quaternion, state, 1), 0.95);
  EXPECT_NEAR(stable_step_at_state(block, Rotation::linearised, state, 1), 1, 1e-3);
}

TEST(StableStepAtState, does_not_change_by_a_turn_of_everything) {
  const Problem pair = fixture::make_pair(LinkLaw::material);
  std::vector<double> state = fixture::rest(pair);
  const double turn = 1.3, length = pair.bodies[0].edge[0];
  for (std::size_t e = 0; e < 2; ++e) {
    state[e * field_count + qs] = std::cos(turn / 2) - 1;
    state[e * field_count + qz] = std::sin(turn / 2);
    const double x = (double(e) - 0.5) * length;
    state[e * field_count + ux] = x * (std::cos(turn) - 1);
    state[e * field_count + uy] = x * std::sin(turn);
  }
  EXPECT_NEAR(stable_step_at_state(pair, Rotation::quaternion, state, 1), 1, 1e-4);
}

} // namespace
} // namespace dss
