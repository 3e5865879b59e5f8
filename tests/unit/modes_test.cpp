/// Exact step limits of small problems, against step matrices built from the oracle. Methods are
/// shipped ones and others.
#include "solver/numerics/dense_eigen.hpp"
#include "solver/numerics/stability.hpp"
#include "tests/fixtures/linear_motion.hpp"
#include "tests/fixtures/methods.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dss {
namespace {

using fixture::rk4;
using fixture::smoothed;
using fixture::verlet;

/// Methods for which the limits must hold, shipped or not.
Method explicit_midpoint() {
  Method method = rk4;
  method.name = "midpoint of the test", method.stages = 2, method.order = 2;
  method.node = {0, 0.5}, method.beta = {0.5, 1}, method.alpha = {{0}, {0, 0}};
  method.imaginary_limit = 0, method.real_limit = 2;
  return method;
}
Method symplectic_euler() {
  Method method = verlet;
  method.name = "symplectic Euler of the test", method.family = Method::Family::symplectic_euler,
  method.order = 1;
  method.imaginary_limit = 2, method.real_limit = 2;
  return method;
}

/// Damping that shares no eigenvectors with the stiffness: the ratio of the two differs from link
/// to link.
Problem unevenly_damped() {
  Problem problem = fixture::make_block(3, 2, 2, LinkLaw::material);
  problem.name = "unevenly damped";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    AxisConstants& c = problem.bodies[0].axis[axis];
    c.d_normal *= 1 + 3 * double(axis);
    for (double& d : c.d_shear) d *= 9 - 4 * double(axis);
    for (double& d : c.d_rot) d *= 1 + 5 * double(axis);
  }
  problem.clamps = {{0, dof_all}, {3, dof_ux | dof_ry}};
  return problem;
}
std::vector<Problem> small_problems() {
  Problem tied = fixture::make_pair(LinkLaw::paper);
  tied.stabilization = {3e4, 20, 9, 1e-2};
  return {unevenly_damped(),
          tied,
          fixture::make_everything(),
          fixture::make_plate(4),
          fixture::make_block(3, 2, 1, LinkLaw::material, 0),
          fixture::make_damped_joint()};
}

/// Spectral radius of a step on the problem, linearised by differences of the oracle.
double radius(const Problem& problem, const Method& method, double h) {
  return spectral_radius(fixture::step_matrix(fixture::linearised(problem, true),
                                              fixture::linearised(problem, false), method, h));
}

TEST(ExactLimit, is_where_an_eigenvalue_of_the_whole_step_matrix_leaves_the_unit_circle) {
  for (const Problem& problem : small_problems()) {
    if (problem.lattice.element_count > 16) continue; // larger step matrices take seconds
    for (const Method& method : {rk4, verlet, smoothed, symplectic_euler()}) {
      const auto exact = Modes(problem).step_limit(method);
      ASSERT_TRUE(exact) << problem.name;
      // Differences, and the double roots of rigid motions, leave some 1e-5 of noise on radii.
      EXPECT_LE(radius(problem, method, 0.998 * exact->dt), 1 + 1e-4)
          << problem.name << ' ' << method.name;
      EXPECT_GE(radius(problem, method, 1.002 * exact->dt), 1 + 2e-4)
          << problem.name << ' ' << method.name;
    }
  }
}

TEST(ExactLimit, is_never_below_the_bound_and_its_mode_has_the_same_limit) {
  for (const Problem& problem : small_problems())
    for (const Method& method : methods()) {
      const StabilityLimit bound = stable_step(problem, method),
                           exact = stable_step(problem, method, true);
      EXPECT_TRUE(exact.is_exact && !bound.is_exact) << problem.name;
      EXPECT_GE(exact.dt, bound.dt * (1 - 1e-9)) << problem.name << ' ' << method.name;
      const double of_mode = mode_step_limit(method, exact.mode.omega, exact.mode.rate);
      EXPECT_NEAR(of_mode, exact.dt, 1e-6 * exact.dt)
          << problem.name << ' ' << method.name; // either both are 0, or they are nearly equal
    }
}

TEST(ExactLimit, of_a_chain_is_that_of_its_highest_mode) {
  // Clamped at one end, free at the other: omega_k = 2 sqrt(k/m) sin((2k - 1) pi / (2 (2N + 1))), k
  // = 1 .. N.
  Problem chain = fixture::make_block(8, 1, 1, LinkLaw::material, 0);
  for (AxisConstants& c : chain.bodies[0].axis) c.k_shear = {1, 1, 1}, c.k_rot = {1e-3, 1e-3, 1e-3};
  chain.clamps = {{0, dof_all}};
  const double n = 7, omega = 2 *
                              std::sqrt(chain.bodies[0].axis[0].k_normal / chain.bodies[0].mass) *
                              std::sin((2 * n - 1) * M_PI / (2 * (2 * n + 1)));
  const StabilityLimit limit = stable_step(chain, rk4, true);
  EXPECT_NEAR(limit.mode.omega / omega, 1, 1e-12);
  EXPECT_NEAR(limit.dt * omega / rk4.imaginary_limit, 1, 1e-9);
  EXPECT_EQ(limit.mode.dof, 0);
}

TEST(ExactLimit, of_problems_beyond_dense_matrices_is_not_claimed) {
  const StabilityLimit limit = stable_step(fixture::make_plate(20), rk4, true);
  EXPECT_FALSE(limit.is_exact);
  EXPECT_NE(limit.how.find("Krylov"), std::string::npos) << limit.how;
}

TEST(StepLimit, of_leapfrog_and_symplectic_euler_is_the_line_between_their_limits_on_the_axes) {
  for (const Method& method : {verlet, smoothed, symplectic_euler()})
    for (const double zeta : {0.0, 0.03, 0.4, 1.0, 3.0, 30.0}) {
      const double h = mode_step_limit(method, 1, 2 * zeta), i = method.imaginary_limit,
                   r = method.real_limit;
      EXPECT_NEAR(h * h / (i * i) + 2 * zeta * h / r, 1, 1e-6) << method.name << " zeta = " << zeta;
    }
}

TEST(StepLimit, is_zero_for_a_method_that_lets_undamped_modes_grow_and_no_more_with_damping) {
  EXPECT_EQ(mode_step_limit(explicit_midpoint(), 50, 0), 0);
  EXPECT_NEAR(mode_step_limit(explicit_midpoint(), 0, 50) * 50, 2, 1e-9);
  // |R|^2 = 1 at 8 zeta = (h omega)^3 to first order.
  EXPECT_NEAR(mode_step_limit(explicit_midpoint(), 1, 2e-4) / std::cbrt(8e-4), 1, 0.01);
  const StabilityLimit undamped =
      stable_step(fixture::make_block(3, 2, 1, LinkLaw::material, 0), explicit_midpoint(), true);
  EXPECT_EQ(undamped.dt, 0);
  EXPECT_NE(undamped.how.find("however small the step"), std::string::npos) << undamped.how;
  EXPECT_GT(
      stable_step(fixture::make_block(3, 2, 1, LinkLaw::material, 1), explicit_midpoint(), true).dt,
      0);
}

TEST(StepLimit, of_a_damped_plate_bounds_such_a_method_away_from_zero_without_its_modes) {
  // Every spring has a damper beside it, so no mode is undamped. The bound uses this.
  EXPECT_GT(stable_step(fixture::make_plate(20), explicit_midpoint()).dt, 1e-7);
}

} // namespace
} // namespace dss
