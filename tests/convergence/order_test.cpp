/// Observed orders of the methods in the oracle, in long double to exclude rounding.
#include "solver/reference/oracle.hpp"
#include "tests/fixtures/methods.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dss {
namespace {

using Real = long double;

using fixture::rk4;
using fixture::smoothed;
using fixture::verlet;

std::vector<Real> run(const Problem& problem, const Method& method,
                      const std::vector<double>& start, double dt, long steps) {
  Oracle<Real> oracle(problem, method, dt);
  oracle.write(start);
  EXPECT_FALSE(oracle.advance(steps)) << "unstable at dt = " << dt;
  return oracle.state();
}

Real distance(const std::vector<Real>& a, const std::vector<Real>& b, int first_field,
              int end_field) {
  Real sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
    if (int(n % field_count) >= first_field && int(n % field_count) < end_field)
      sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(sum);
}

/// Order from three runs with steps dt, dt / 2, dt / 4. Each kind of field must show it.
void expect_order(const Problem& problem, const Method& method, const std::vector<double>& start,
                  double dt, long steps) {
  const auto coarse = run(problem, method, start, dt, steps);
  const auto middle = run(problem, method, start, dt / 2, 2 * steps);
  const auto fine = run(problem, method, start, dt / 4, 4 * steps);
  const std::vector<std::pair<int, int>> kinds = {{ux, vx}, {vx, qs}, {qs, wx}, {wx, field_count}};
  for (const auto& [first, end] : kinds) {
    const Real ratio = distance(coarse, middle, first, end) / distance(middle, fine, first, end);
    EXPECT_NEAR(double(std::log2(ratio)), method.order, 0.1)
        << problem.name << ", fields " << first << " to " << end;
  }
}

std::vector<double> at_rest(const Problem& problem) {
  return std::vector<double>(problem.lattice.element_count * field_count, 0);
}

void expect_order_on_the_papers_plate(const Method& method, double dt, long steps) {
  const Problem plate = fixture::make_plate(10);
  expect_order(plate, method, at_rest(plate), dt, steps);
}

void expect_order_on_every_term(const Method& method, double dt, long steps) {
  Problem problem = fixture::make_everything();
  for (Load& load : problem.loads) // kinks in time would hide the order
    if (load.signal.kind == Signal::Kind::ramp || load.signal.kind == Signal::Kind::table)
      load.signal.kind = {};
  expect_order(problem, method, fixture::random_state(problem, 3, 2e-3, 1.2, 0.3), dt, steps);
}

TEST(Rk4, is_fourth_order_on_the_papers_plate) { expect_order_on_the_papers_plate(rk4, 1e-6, 500); }

TEST(Rk4, is_fourth_order_on_every_term_with_large_rotations) {
  expect_order_on_every_term(rk4, 1e-4, 400);
}

TEST(VelocityVerlet, is_second_order_on_the_papers_damped_plate) {
  expect_order_on_the_papers_plate(verlet, 1e-7, 2000);
}

TEST(VelocityVerlet, is_second_order_on_an_undamped_block) {
  const Problem block = fixture::make_block(3, 2, 2, LinkLaw::material, 0);
  expect_order(block, verlet, fixture::random_state(block, 3, 1e-3, 0.2, 0.1), 2e-5, 500);
}

TEST(VelocityVerlet, is_second_order_on_every_term_with_large_rotations) {
  expect_order_on_every_term(verlet, 1e-5, 1000);
}

TEST(SmoothedVerlet, is_second_order_on_the_papers_damped_plate) {
  expect_order_on_the_papers_plate(smoothed, 2.5e-8, 8000);
}

TEST(SmoothedVerlet, is_second_order_on_every_term_with_large_rotations) {
  expect_order_on_every_term(smoothed, 5e-6, 2000);
}

TEST(SmoothedVerlet, is_velocity_verlet_where_nothing_depends_on_velocities) {
  Problem plate = fixture::make_plate(4); // cubes have no gyroscopic term
  for (AxisConstants& c : plate.bodies[0].axis) c.d_normal = 0, c.d_shear = c.d_rot = {};
  EXPECT_EQ(run(plate, smoothed, at_rest(plate), 1e-6, 50),
            run(plate, verlet, at_rest(plate), 1e-6, 50));
}

/// Element 0 is held, element 1 is pulled along the link: m x'' + d x' + k x = f for either law.
class PulledPair : public testing::TestWithParam<LinkLaw> {
protected:
  static Problem problem() {
    Problem pair = fixture::make_pair(GetParam());
    pair.clamps = {{0, dof_all}};
    pair.loads = {{{1}, {250, 0, 0}, {0, 0, 0}, {}}};
    return pair;
  }
  static Real exact(const Problem& pair, Real t) {
    const Real k = pair.bodies[0].axis[0].k_normal, m = pair.bodies[0].mass;
    const Real decay = pair.bodies[0].axis[0].d_normal / (2 * m),
               omega = std::sqrt(k / m - decay * decay);
    return 250 / k *
           (1 - std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t)));
  }
  static Real error(const Method& method, double dt, long steps) {
    const Problem pair = problem();
    const auto state = run(pair, method, at_rest(pair), dt, steps);
    return std::abs(state[field_count + ux] - exact(pair, Real(dt) * Real(steps)));
  }
};

TEST_P(PulledPair, approaches_its_closed_form_at_the_order_of_the_method) {
  for (const Method& method : methods()) {
    const double dt = method.order > 5    ? 2e-3
                      : method.order > 4  ? 2.5e-4
                      : method.order == 4 ? 1e-3
                                          : 1e-4; // above the rounding of the table
    const Real coarse = error(method, dt, std::lround(0.1 / dt)),
               fine = error(method, dt / 2, std::lround(0.2 / dt));
    EXPECT_NEAR(double(std::log2(coarse / fine)), method.order, 0.1) << method.name;
    EXPECT_LT(fine, method.order == 1 ? 1e-4 : 1e-5) << method.name;
  }
}

/// A smoothed correction lags by 1 / (1 - s) steps. The error of damping is larger by the same
/// factor.
TEST_P(PulledPair, has_an_error_of_damping_that_grows_as_smoothing_lags) {
  const Problem pair = problem();
  const auto displacement = [&](double smoothing) {
    Method method = verlet;
    method.smoothing = smoothing;
    return run(pair, method, at_rest(pair), 1e-5, 10000)[field_count + ux];
  };
  const Real none = displacement(0);
  EXPECT_NEAR(double((displacement(0.75) - none) / (displacement(0.5) - none)), 3, 0.05);
}

INSTANTIATE_TEST_SUITE_P(laws, PulledPair, testing::Values(LinkLaw::paper, LinkLaw::material),
                         [](const testing::TestParamInfo<LinkLaw>& law) {
                           return law.param == LinkLaw::paper ? "paper" : "material";
                         });

/// Energy relative to the start, for a free block that tumbles and vibrates.
std::vector<double> relative_energies(const Method& method, double dt, long steps, int samples,
                                      double damping = 0) {
  const Problem box = fixture::make_tumbling_box(damping);
  Oracle<double> oracle(box, method, dt);
  std::vector<double> state = fixture::random_state(box, 8, 1e-3, 0, 0.1);
  const std::vector<double> spin = initial_state(box);
  for (std::size_t n = 0; n < state.size(); ++n) state[n] += spin[n];
  oracle.write(state);
  const double begin = oracle.energy();
  std::vector<double> energies;
  for (int sample = 0; sample < samples; ++sample) {
    EXPECT_FALSE(oracle.advance(steps / samples));
    energies.push_back(oracle.energy() / begin - 1);
  }
  return energies;
}

/// Mean of the last quarter minus that of the first, in units of the largest deviation.
double trend(const std::vector<double>& error) {
  double difference = 0, largest = 0;
  const std::size_t quarter = error.size() / 4;
  for (std::size_t n = 0; n < quarter; ++n)
    difference += (error[error.size() - 1 - n] - error[n]) / double(quarter);
  for (const double e : error) largest = std::max(largest, std::abs(e));
  return difference / largest;
}

TEST(VelocityVerlet, shows_no_energy_trend_over_100000_steps) {
  const std::vector<double> error = relative_energies(verlet, 2e-4, 100'000, 1000);
  for (const double e : error) ASSERT_LT(std::abs(e), 1e-5);
  EXPECT_LT(std::abs(trend(error)), 0.2); // its error oscillates with the tumbling
  EXPECT_LT(trend(relative_energies(verlet, 2e-4, 100'000, 1000, 1e-4)), -0.4)
      << "a trend must be seen where there is one";
}

TEST(Rk4, loses_energy_at_its_order_and_one_more) {
  // The amplitude of a mode falls by (h omega)^6 / 144 a step. Over a fixed time the loss of energy
  // is therefore of fifth order.
  const double coarse = relative_energies(rk4, 4e-4, 500, 1).back(),
               fine = relative_energies(rk4, 2e-4, 1000, 1).back();
  EXPECT_LT(coarse, 0);
  EXPECT_NEAR(std::log2(coarse / fine), 5, 0.25);
}

} // namespace
} // namespace dss
