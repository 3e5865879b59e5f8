#include "solver/numerics/dense_eigen.hpp"
#include "solver/numerics/spectrum.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/reference/oracle.hpp"
#include "tests/fixtures/linear_motion.hpp"
#include "tests/fixtures/methods.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dss {
namespace {

using fixture::rk4;
using fixture::verlet;

/// Largest eigenvalue over the free degrees of freedom. The rows of clamped ones are already zero.
double largest_eigenvalue(const Eigen::MatrixXd& matrix) {
  return eigenvalues(matrix).real().maxCoeff();
}

std::vector<Problem> spectra() {
  Problem clamped = fixture::make_block(2, 2, 2, LinkLaw::material);
  clamped.clamps = {{0, dof_all}, {3, dof_ux | dof_ry}};
  Problem tied = fixture::make_pair(LinkLaw::paper);
  tied.stabilization = {3e4, 20, 9, 1e-2};
  return {fixture::make_pair(LinkLaw::paper),
          fixture::make_pair(LinkLaw::material),
          fixture::make_plate(5),
          fixture::make_block(3, 2, 2, LinkLaw::paper),
          fixture::make_everything(),
          clamped,
          tied};
}

TEST(Rk4, has_the_known_step_limits_of_a_damped_mode) {
  const double omega = 37;
  for (const auto& [zeta, limit] : {std::pair{0.0, 2.828},
                                    {0.01, 2.849},
                                    {0.1, 2.951},
                                    {0.5, 2.622},
                                    {1.0, 2.785},
                                    {1.5, 1.064},
                                    {2.0, 0.746},
                                    {10.0, 0.1396}})
    EXPECT_NEAR(omega * mode_step_limit(rk4, omega, 2 * zeta * omega) / limit, 1, 0.005)
        << "zeta = " << zeta;
}

TEST(VelocityVerlet, has_the_step_limit_of_its_predictor) {
  // The step matrix has the eigenvalue -1 where (h omega)^2 + 4 h rate = 4.
  const double omega = 5;
  for (const double zeta : {0.0, 0.01, 0.1, 0.5, 1.0, 10.0})
    EXPECT_NEAR(omega * mode_step_limit(verlet, omega, 2 * zeta * omega),
                std::sqrt(16 * zeta * zeta + 4) - 4 * zeta, 1e-6)
        << "zeta = " << zeta;
}

TEST(StepLimit, of_a_mode_does_not_depend_on_its_scale) {
  for (const Method& method : methods())
    EXPECT_NEAR(mode_step_limit(method, 1e6, 3e5) * 1e6, mode_step_limit(method, 1e-3, 3e-4) * 1e-3,
                1e-9);
}

TEST(Spectrum, bound_is_never_below_the_eigenvalues_of_the_oracle_and_seldom_far_above) {
  for (const Problem& problem : spectra()) {
    const Spectrum bound = spectrum_bound(problem);
    const double omega = std::sqrt(largest_eigenvalue(fixture::linearised(problem, true)));
    const double damping = largest_eigenvalue(fixture::linearised(problem, false));
    EXPECT_GE(bound.omega_max, omega * (1 - 1e-8)) << problem.name;
    EXPECT_LE(bound.omega_max, omega / 0.7) << problem.name;
    EXPECT_GE(bound.damping, damping * (1 - 1e-8)) << problem.name;
    EXPECT_LE(bound.damping, damping / 0.5) << problem.name;
  }
}

TEST(Spectrum, krylov_figures_are_the_eigenvalues_of_the_oracle) {
  for (const Problem& problem : spectra()) {
    const Spectrum found = krylov_spectrum(problem);
    EXPECT_NEAR(found.omega_max / std::sqrt(largest_eigenvalue(fixture::linearised(problem, true))),
                1, 3e-4)
        << problem.name;
    EXPECT_NEAR(found.damping / largest_eigenvalue(fixture::linearised(problem, false)), 1, 5e-4)
        << problem.name;
  }
}

TEST(StableStep, of_the_papers_plate_allows_the_papers_step_by_rk4) {
  const StabilityLimit quick = stable_step(fixture::make_plate(20), rk4);
  const StabilityLimit sharp = stable_step(fixture::make_plate(20), rk4, true);
  EXPECT_GT(quick.dt, 2e-6);
  EXPECT_LE(quick.dt, sharp.dt);
  EXPECT_LE(sharp.omega_max, std::sqrt(8.01e11));
  EXPECT_GE(sharp.omega_max, std::sqrt(7.8e11));
  EXPECT_NE(sharp.how, quick.how);
}

/// Largest displacement after `steps` steps from a small random state. Infinite if the run broke
/// down.
double growth(Problem problem, const Method& method, double dt, long steps) {
  Oracle<double> oracle(problem, method, dt);
  std::vector<double> state = fixture::random_state(problem, 7, 1e-9, 1e-9, 1e-9);
  for (const Clamp& clamp : problem.clamps) // this handles only full clamps
    std::fill_n(state.begin() + std::ptrdiff_t(clamp.element * field_count), field_count, 0.0);
  oracle.write(state);
  if (oracle.advance(steps)) return std::numeric_limits<double>::infinity();
  oracle.read(state);
  double largest = 0;
  for (const double value : state) largest = std::max(largest, std::abs(value));
  return largest;
}

TEST(StableStep, separates_runs_that_stay_bounded_from_runs_that_grow) {
  // Undamped: the worst pairing is then the true one, and the prediction is sharp on both sides.
  Problem block = fixture::make_block(4, 3, 2, LinkLaw::material, 0);
  for (const Method& method : methods()) {
    const double dt = stable_step(block, method, true).dt;
    if (dt == 0) continue; // grows at every step, too slowly to see here
    EXPECT_LT(growth(block, method, 0.99 * dt, 3000), 1e-5) << method.name;
    if (method.order == 5)
      continue; // grows by 5e-6 a step at 1 % above its limit: tests/runner/stability_test.cpp
                // waits for it
    EXPECT_GT(growth(block, method, 1.01 * dt, 3000), 1) << method.name;
  }
}

TEST(StableStep, is_safe_for_damped_problems) {
  for (const Method& method : methods()) {
    Problem plate = fixture::make_plate(8);
    plate.loads.clear();
    const double dt = stable_step(plate, method, true).dt;
    EXPECT_LT(growth(plate, method, 0.999 * dt, 2000), 1e-3) << method.name;
    EXPECT_GT(growth(plate, method, 1.3 * dt, 2000), 1) << method.name;
  }
}

TEST(StableStep, is_infinite_where_nothing_can_vibrate) {
  EXPECT_EQ(stable_step(fixture::make_block(1, 1, 1, LinkLaw::paper), rk4).dt,
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(stable_step(fixture::make_block(1, 1, 1, LinkLaw::paper), verlet, true).dt,
            std::numeric_limits<double>::infinity());
}

TEST(StableStep, of_a_lone_tied_element_is_that_of_its_springs) {
  Problem problem = fixture::make_block(1, 1, 1, LinkLaw::paper);
  problem.stabilization.k = 600;
  for (const bool sharp : {false, true}) {
    const StabilityLimit limit = stable_step(problem, rk4, sharp);
    EXPECT_NEAR(limit.omega_max, std::sqrt(600 / problem.bodies[0].mass), 1e-9);
    EXPECT_NEAR(limit.dt, rk4.imaginary_limit / limit.omega_max, 1e-8);
  }
}

TEST(StableStep, says_that_a_large_problem_gets_no_sharp_figure) {
  const Problem plate = fixture::make_plate(142);
  const StabilityLimit limit = stable_step(plate, rk4, true);
  EXPECT_NE(limit.how.find("no sharp figure"), std::string::npos) << limit.how;
  EXPECT_EQ(limit.dt, stable_step(plate, rk4).dt);
}

TEST(Fitted, rkc2_has_as_many_stages_as_the_damping_needs_and_no_more) {
  Problem pair = fixture::make_pair(LinkLaw::paper);
  for (Body& body : pair.bodies)
    for (int a = 0; a < 3; ++a) { // about forty times critical
      AxisConstants& axis = body.axis[std::size_t(a)];
      axis.d_normal = 40 * std::sqrt(axis.k_normal * body.mass);
      axis.d_shear = across(a, axis.d_normal);
      axis.d_rot = {1, 1, 1};
    }
  const double dt = 5 * stable_step(pair, rk4).dt;
  const Method method = fitted(pair, *find_method("rkc2"), dt);
  EXPECT_GT(method.stages, 3);
  EXPECT_GE(stable_step(pair, method, true).dt, dt);
  EXPECT_LT(stable_step(pair, rkc2(method.stages - 1), true).dt, dt);
  EXPECT_EQ(fitted(pair, rk4, dt).stages, rk4.stages);
}

} // namespace
} // namespace dss
