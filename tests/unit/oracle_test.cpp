#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/reference/oracle.hpp"
#include "tests/fixtures/methods.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace dss {
namespace {

using fixture::rest;
using fixture::rk4;
using fixture::verlet;

std::vector<double> rates_of(const Problem& problem, const std::vector<double>& state,
                             double t = 0) {
  Oracle<double> oracle(problem, rk4, problem.dt);
  oracle.write(state);
  std::vector<double> rates(state.size());
  oracle.derivative(t, rates);
  return rates;
}

template <class T>
std::vector<double> read_all(const Oracle<T>& oracle, const Problem& problem) {
  std::vector<double> state = rest(problem);
  oracle.read(state);
  return state;
}

TEST(Oracle, leaves_an_unloaded_problem_at_rest_to_the_last_bit) {
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material})
    for (const Method& method : methods()) {
      const Problem block = fixture::make_block(3, 3, 2, law);
      Oracle<double> oracle(block, method, block.dt);
      EXPECT_FALSE(oracle.advance(20));
      EXPECT_EQ(read_all(oracle, block), rest(block)) << method.name;
    }
}

TEST(Oracle, exerts_no_net_force_and_no_net_moment_on_a_free_block) {
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material}) {
    // The paper's damping exchanges a moment across open gaps. The net moment is therefore taken
    // without damping.
    Problem block = fixture::make_block(4, 3, 3, law, law == LinkLaw::material ? 1 : 0);
    block.bodies[0].inertia.fill(0.02); // no gyroscopic term: moment = inertia * rate of w
    const std::vector<double> state = fixture::random_state(block, 5),
                              rates = rates_of(block, state);
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    double force_sum = 0, moment_sum = 0;
    block.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
      const double *y = &state[e * field_count], *r = &rates[e * field_count];
      const Vec3 at = rest_position(block, row, x);
      const Eigen::Vector3d place(at[0] + y[ux], at[1] + y[uy], at[2] + y[uz]);
      const Eigen::Vector3d f = block.bodies[0].mass * Eigen::Vector3d(r[vx], r[vy], r[vz]);
      const Eigen::Vector3d m = 0.02 * Eigen::Vector3d(r[wx], r[wy], r[wz]);
      force += f;
      moment += m + place.cross(f);
      force_sum += f.norm();
      moment_sum += m.norm() + place.cross(f).norm();
    });
    EXPECT_LE(force.norm(), 1e-14 * force_sum);
    EXPECT_LE(moment.norm(), 1e-14 * moment_sum);
  }
}

TEST(Oracle, accelerates_a_lone_element_by_frame_load_and_springs_except_where_it_is_clamped) {
  Problem lone = fixture::make_block(1, 1, 1, LinkLaw::paper);
  lone.bodies[0].inertia.fill(0.5);
  lone.frame_acceleration[2].amplitude = -9.81;
  lone.frame_acceleration[1].kind = Signal::Kind::ramp;
  lone.frame_acceleration[1].amplitude = 4;
  lone.frame_acceleration[1].duration = 2;
  lone.loads = {{{0}, {3, 0, 0}, {0, 0, 2}, {}}};
  lone.loads[0].signal.amplitude = 10;
  lone.stabilization = {100, 10, 6, 1};
  lone.clamps = {{0, dof_uz | dof_rx}};
  std::vector<double> state = rest(lone);
  state[ux] = 0.2;
  state[vy] = 0.3;
  state[qs] = std::cos(0.05) - 1;
  state[qx] = state[qz] = std::sin(0.05) / std::sqrt(2);
  state[wz] = 0.7;
  const std::vector<double> rates = rates_of(lone, state, 1.0);
  const double mass = lone.bodies[0].mass;
  EXPECT_DOUBLE_EQ(rates[vx], (30 - 100 * 0.2) / mass);
  EXPECT_DOUBLE_EQ(rates[vy], 2 - 10 * 0.3 / mass);
  EXPECT_EQ(rates[vz], 0);
  EXPECT_EQ(rates[wx], 0);
  EXPECT_DOUBLE_EQ(rates[wz], (20 - 12 * state[qz] - 0.7) / 0.5);
  EXPECT_DOUBLE_EQ(rates[uy], 0.3);
  // dq/dt = w (x) q / 2 for w along z.
  EXPECT_DOUBLE_EQ(rates[qs], -0.7 * state[qz] / 2);
  EXPECT_DOUBLE_EQ(rates[qx], -0.7 * state[qy] / 2);
  EXPECT_DOUBLE_EQ(rates[qy], 0.7 * state[qx] / 2);
  EXPECT_DOUBLE_EQ(rates[qz], 0.7 * (1 + state[qs]) / 2);
}

/// Angular momentum A diag(I) A^T w of the only element.
Eigen::Vector3d angular_momentum(const Problem& lone, const std::vector<double>& state) {
  const auto motion = reference::motion_of(state.data());
  const Vec3& inertia = lone.bodies[0].inertia;
  const Eigen::Vector3d body_spin = motion.rotation().transpose() * motion.w;
  return motion.rotation() *
         Eigen::Vector3d(inertia[0], inertia[1], inertia[2]).cwiseProduct(body_spin);
}

TEST(Oracle, keeps_angular_momentum_and_energy_of_a_tumbling_box) {
  const Problem lone = fixture::make_block(1, 1, 1, LinkLaw::paper);
  ASSERT_TRUE(lone.bodies[0].has_tensor_inertia());
  std::vector<double> state = rest(lone);
  state[wx] = 3;
  state[wy] = 5;
  state[wz] = -4;
  for (const auto& [method, tolerance] : {std::pair{&rk4, 1e-9}, {&verlet, 2e-4}}) {
    Oracle<double> oracle(lone, *method, 1e-3);
    oracle.write(state);
    const double energy = oracle.energy();
    const Eigen::Vector3d before = angular_momentum(lone, state);
    ASSERT_FALSE(oracle.advance(200));
    EXPECT_GT(std::abs(read_all(oracle, lone)[wx] - 3), 0.1)
        << "the box must tumble, not spin about one axis";
    ASSERT_FALSE(oracle.advance(1800));
    const std::vector<double> after = read_all(oracle, lone);
    EXPECT_NEAR(oracle.energy() / energy, 1, tolerance) << method->name;
    EXPECT_LE((angular_momentum(lone, after) - before).norm(), tolerance * before.norm())
        << method->name;
  }
}

TEST(Oracle, gives_the_same_bits_whether_a_run_is_split_or_not) {
  const Problem problem = fixture::make_everything();
  const std::vector<double> start = fixture::random_state(problem, 2, 1e-3, 0.3, 0.1);
  for (const Method& method : methods()) {
    Oracle<double> whole(problem, method, problem.dt), split(problem, method, problem.dt);
    whole.write(start);
    split.write(start);
    ASSERT_FALSE(whole.advance(10));
    ASSERT_FALSE(split.advance(4));
    ASSERT_FALSE(split.advance(6));
    EXPECT_EQ(read_all(whole, problem), read_all(split, problem)) << method.name;
    EXPECT_EQ(split.step_count(), 10);
  }
}

TEST(Oracle, takes_rows_of_signals_as_it_takes_the_problems_own) {
  const Problem problem = fixture::make_everything();
  for (const Method& method : methods()) {
    Oracle<double> own(problem, method, problem.dt), given(problem, method, problem.dt);
    const std::size_t width = signal_count(problem);
    const std::vector<double> rows = signal_rows(problem, method, problem.dt, 0, 12);
    ASSERT_EQ(rows.size(), width * std::size_t(12 * method.stages + 1));
    ASSERT_FALSE(own.advance(12));
    ASSERT_FALSE(given.advance(12, [&](long step, int stage) {
      return std::span(rows).subspan(std::size_t(step * method.stages + stage) * width, width);
    }));
    EXPECT_EQ(read_all(own, problem), read_all(given, problem)) << method.name;
    EXPECT_NE(read_all(own, problem), rest(problem));
  }
}

TEST(Oracle, starts_anew_after_a_write) {
  const Problem problem = fixture::make_everything();
  const std::vector<double> start = fixture::random_state(problem, 4, 1e-3, 0.3, 0.1);
  for (const Method& method : methods()) {
    Oracle<double> fresh(problem, method, problem.dt), used(problem, method, problem.dt);
    ASSERT_FALSE(used.advance(5));
    used.write(start);
    fresh.write(start);
    EXPECT_EQ(used.step_count(), 0);
    ASSERT_FALSE(used.advance(5));
    ASSERT_FALSE(fresh.advance(5));
    EXPECT_EQ(read_all(used, problem), read_all(fresh, problem)) << method.name;
  }
}

TEST(Oracle, says_where_and_when_a_run_stops_being_finite) {
  const Problem problem = fixture::make_block(3, 1, 1, LinkLaw::paper);
  for (const Method& method : methods()) {
    Oracle<double> oracle(problem, method, problem.dt);
    std::vector<double> state = rest(problem);
    oracle.write(state);
    ASSERT_FALSE(oracle.advance(7));
    state[2 * field_count + vy] = std::numeric_limits<double>::infinity();
    oracle.write(std::span(state).subspan(2 * field_count), 2);
    const auto breakdown = oracle.advance(5);
    ASSERT_TRUE(breakdown) << method.name;
    EXPECT_EQ(breakdown->step, 0) << method.name;

    Oracle<double> unstable(problem, method, 8 * stable_step(problem, *find_method("rk4")).dt);
    unstable.write(fixture::random_state(problem, 1, 1e-12, 1e-12, 1e-12));
    const auto growth = unstable.advance(100000);
    ASSERT_TRUE(growth) << method.name;
    EXPECT_GT(growth->step, 0) << method.name;
    EXPECT_EQ(unstable.step_count(), growth->step + 1) << method.name;
  }
}

TEST(Oracle, agrees_with_itself_in_every_precision_to_that_precision) {
  const Problem problem = fixture::make_everything();
  const std::vector<double> start = fixture::random_state(problem, 9, 1e-2, 1, 0.5);
  for (const Method& method : methods()) {
    Oracle<float> f32(problem, method, problem.dt);
    Oracle<double> f64(problem, method, problem.dt);
    Oracle<long double> f80(problem, method, problem.dt);
    f32.write(start);
    f64.write(start);
    f80.write(start);
    ASSERT_FALSE(f32.advance(100));
    ASSERT_FALSE(f64.advance(100));
    ASSERT_FALSE(f80.advance(100));
    const auto a = read_all(f32, problem), b = read_all(f64, problem), c = read_all(f80, problem);
    double largest = 0, error32 = 0, error64 = 0;
    for (std::size_t n = 0; n < c.size(); ++n) {
      largest = std::max(largest, std::abs(c[n]));
      error32 = std::max(error32, std::abs(a[n] - c[n]));
      error64 = std::max(error64, std::abs(b[n] - c[n]));
    }
    EXPECT_LE(error64, 1e-12 * largest) << method.name;
    EXPECT_LE(error32, 1e-3 * largest) << method.name;
    EXPECT_GT(error32, 100 * error64) << method.name;
  }
}

} // namespace
} // namespace dss
