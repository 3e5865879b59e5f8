#include "solver/error.hpp"
#include "solver/model/energy.hpp"
#include "solver/reference/oracle.hpp"
#include "tests/fixtures/methods.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace dss {
namespace {

using fixture::rk4;

TEST(TotalEnergy, is_zero_at_rest) {
  const Problem problem = fixture::make_everything();
  EXPECT_EQ(total_energy(problem, fixture::rest(problem)), 0);
}

TEST(TotalEnergy, of_a_stretched_moving_pair_is_that_of_a_spring_and_two_masses) {
  const Problem pair = fixture::make_pair(LinkLaw::material);
  const Body& body = pair.bodies[0];
  std::vector<double> state(2 * field_count, 0);
  state[field_count + ux] = 0.01;
  state[vy] = 3;
  state[field_count + wz] = 2;
  const double expected =
      body.axis[0].k_normal * 1e-4 / 2 + body.mass * 9 / 2 + body.inertia[2] * 4 / 2;
  EXPECT_NEAR(total_energy(pair, state), expected, 1e-14 * expected);
}

TEST(TotalEnergy, of_stabilizing_springs_is_the_work_that_they_take_up) {
  Problem lone = fixture::make_block(1, 1, 1, LinkLaw::paper);
  lone.stabilization = {50, 0, 7, 0};
  std::vector<double> state(field_count, 0);
  const double turn = 1.2;
  state[uz] = 0.3;
  state[qs] = std::cos(turn / 2) - 1;
  state[qy] = std::sin(turn / 2);
  // The moment is 2 k_rot sin(turn / 2). Its integral is 4 k_rot (1 - cos(turn / 2)).
  const double expected = 50 * 0.09 / 2 + 4 * 7 * (1 - std::cos(turn / 2));
  EXPECT_NEAR(total_energy(lone, state), expected, 1e-14 * expected);
}

/// dE/dt by central differences along the oracle's rates.
double power(const Problem& problem, const std::vector<double>& state,
             const std::vector<double>& rates) {
  const auto at = [&](double t) {
    std::vector<double> moved = state;
    for (std::size_t n = 0; n < moved.size(); ++n) moved[n] += t * rates[n];
    return total_energy(problem, moved);
  };
  const double h = 1e-6;
  return (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
}

TEST(TotalEnergy, changes_only_by_the_work_of_loads_and_dampers) {
  Problem problem = fixture::make_everything();
  const auto undamp = [](AxisConstants& c) {
    c.d_normal = 0;
    c.d_shear = c.d_rot = {};
  };
  for (Body& body : problem.bodies) {
    std::ranges::for_each(body.axis, undamp);
    for (auto& kind : body.more_kinds) std::ranges::for_each(kind, undamp);
  }
  for (ExtraLink& link : problem.extra_links) undamp(link.constants);
  problem.clamps.clear();
  problem.stabilization.d = problem.stabilization.d_rot = 0;
  const std::vector<double> state = fixture::random_state(problem, 11);
  std::vector<double> rates(state.size());
  Oracle<double> oracle(problem, rk4, problem.dt);
  oracle.write(state);
  std::vector<double> signals(3 + problem.loads.size(), 0);
  oracle.derivative(signals, rates);
  const double scale = total_energy(problem, state) * 100; // the shortest time scale is about 10 ms
  EXPECT_NEAR(power(problem, state, rates), 0, 1e-9 * scale);

  signals[3] = 1; // the first load: force {3, -1, 2} on its elements
  oracle.derivative(signals, rates);
  double work = 0;
  for (const std::size_t e : problem.loads[0].elements)
    for (std::size_t axis = 0; axis < 3; ++axis)
      work += problem.loads[0].force[axis] * state[e * field_count + vx + axis];
  EXPECT_NEAR(power(problem, state, rates), work, 1e-9 * scale);
  EXPECT_GT(std::abs(work), 1e-6 * scale);
}

TEST(TotalEnergy, refuses_a_state_of_another_size) {
  const Problem pair = fixture::make_pair(LinkLaw::paper);
  EXPECT_THROW(total_energy(pair, std::vector<double>(field_count)), InputError);
}

} // namespace
} // namespace dss
