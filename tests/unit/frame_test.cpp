/// A frame that rotates: its motion, and bodies in it against the same bodies in fixed axes.
#include "solver/error.hpp"
#include "solver/model/energy_balance.hpp"
#include "solver/model/frame.hpp"
#include "solver/model/reactions.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/numerics/method.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/oracle.hpp"
#include "solver/statics/static_system.hpp"
#include "tests/fixtures/problems.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace dss {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Signal swing(double amplitude, double frequency, double phase) {
  Signal signal;
  signal.kind = Signal::Kind::harmonic;
  signal.amplitude = amplitude, signal.frequency = frequency, signal.phase = phase;
  return signal;
}
Signal spin_up(double rate) {
  Signal signal;
  signal.kind = Signal::Kind::rate;
  signal.amplitude = rate;
  return signal;
}
/// Turns about changing axes, by `size` radians.
void set_rotation(Problem& problem, double size, double frequency) {
  problem.frame_rotation = {swing(size, frequency, 0.3), swing(-0.7 * size, 1.3 * frequency, 1),
                            swing(0.4 * size, 0.8 * frequency, -2)};
}

TEST(FrameTurn, has_the_rates_of_its_axes) {
  Problem problem;
  for (const double size : {1e-3, 0.15, 0.5, 3.0}) {
    set_rotation(problem, size, 0.9);
    const double t = 0.37, h = 1e-4;
    const FrameTurn now = turn_of_frame(problem, t), before = turn_of_frame(problem, t - h),
                    after = turn_of_frame(problem, t + h);
    EXPECT_LE((now.axes * now.axes.transpose() - Matrix3d::Identity()).norm(), 1e-14);
    const Matrix3d spin = now.axes.transpose() * (after.axes - before.axes) / (2 * h);
    const Vector3d rate{spin(2, 1), spin(0, 2), spin(1, 0)};
    EXPECT_LE((now.rate - rate).norm(), 1e-5 * size) << size;
    EXPECT_LE((now.acceleration - (after.rate - before.rate) / (2 * h)).norm(), 1e-5 * size)
        << size;
  }
}

TEST(FrameTurn, is_smooth_where_its_formulas_change) {
  Problem problem;
  problem.frame_rotation[0] = spin_up(0.6), problem.frame_rotation[1] = spin_up(-0.8);
  problem.frame_rotation[2] = swing(1e-3, 0.5, 0);
  const FrameTurn below = turn_of_frame(problem, 1 - 1e-9),
                  above = turn_of_frame(problem, 1 + 1e-9);
  EXPECT_LE((above.rate - below.rate).norm(), 1e-10);
  EXPECT_LE((above.acceleration - below.acceleration).norm(), 1e-10);
}

TEST(FrameTurn, spins_about_one_axis_by_any_angle) {
  Problem problem;
  problem.frame_rotation[2] = spin_up(5);
  const FrameTurn turn = turn_of_frame(problem, 7);
  EXPECT_LE((turn.rate - Vector3d(0, 0, 5)).norm(), 1e-13);
  EXPECT_LE(turn.acceleration.norm(), 1e-12);
  EXPECT_NEAR(turn.axes(1, 0), std::sin(35), 1e-13);
}

TEST(Spline, goes_through_its_points_with_two_derivatives) {
  Signal signal;
  for (int k = 0; k < 9; ++k) {
    signal.times.push_back(k + 0.2 * (k % 2));
    signal.values.push_back(std::sin(0.7 * signal.times.back()));
  }
  signal.kind = Signal::Kind::table;
  make_spline(signal);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(signal(signal.times[k]), signal.values[k], 1e-15);
    const double t = signal.times[k], h = 1e-6;
    EXPECT_NEAR(motion_of(signal, t - h).rate, motion_of(signal, t + h).rate, 1e-5) << k;
    EXPECT_NEAR(motion_of(signal, t - h).acceleration, motion_of(signal, t + h).acceleration, 1e-5)
        << k;
  }
  for (const double t : {-1.0, 0.4, 3.3, 5.9, 9.0}) {
    const double h = 1e-3;
    const SignalMotion m = motion_of(signal, t);
    EXPECT_NEAR(m.rate, (signal(t + h) - signal(t - h)) / (2 * h), 1e-6) << t;
    EXPECT_NEAR(m.acceleration, (signal(t + h) - 2 * signal(t) + signal(t - h)) / (h * h), 1e-6)
        << t;
  }
  EXPECT_NEAR(signal(4.5), std::sin(0.7 * 4.5), 2e-3);
  Signal pair;
  pair.times = {1, 3}, pair.values = {2, 6};
  make_spline(pair);
  EXPECT_DOUBLE_EQ(pair(2.5), 5);
  EXPECT_DOUBLE_EQ(motion_of(pair, 9).rate, 2);
}

/// Fields in a frame from those in fixed axes, at a time.
std::vector<double> seen_from_frame(const Problem& problem, const std::vector<double>& fixed,
                                    double t) {
  const FrameTurn turn = turn_of_frame(problem, t);
  const Matrix3d back = turn.axes.transpose();
  std::vector<double> seen = fixed;
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const Vec3 rest = rest_position(problem, row, x);
    const Vector3d at_rest(rest[0], rest[1], rest[2]);
    const double* from = &fixed[e * field_count];
    double* to = &seen[e * field_count];
    const Vector3d place = back * (at_rest + Vector3d(from + ux));
    Eigen::Map<Vector3d>(to + ux) = place - at_rest;
    Eigen::Map<Vector3d>(to + vx) = back * Vector3d(from + vx) - turn.rate.cross(place);
    Eigen::Map<Vector3d>(to + wx) = back * Vector3d(from + wx) - turn.rate;
    Quaterniond q = Quaterniond(back) * Quaterniond(1 + from[qs], from[qx], from[qy], from[qz]);
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    to[qs] = q.w() - 1, to[qx] = q.x(), to[qy] = q.y(), to[qz] = q.z();
  });
  return seen;
}

/// A free body of elements with a tensor inertia, under gravity. Dampers of the paper's law resist
/// even a rigid motion if gaps are open, so they would resist the frame's.
Problem tumbling_body(LinkLaw law) {
  Problem problem = fixture::make_block(3, 2, 2, law, law == LinkLaw::paper ? 0 : 0.3);
  problem.bodies[0].edge = {0.1, 0.07, 0.05};
  problem.bodies[0].inertia = fixture::box_inertia(problem.bodies[0].mass, problem.bodies[0].edge);
  problem.bodies[0].origin = {0.3, -0.2, 0.1};
  problem.frame_acceleration[2].amplitude = -9.81;
  problem.clamps.clear(), problem.loads.clear();
  return problem;
}

std::vector<double> ran(const Problem& problem, const std::vector<double>& start, double end,
                        long steps) {
  Oracle<double> oracle(problem, *find_method("rk4"), end / double(steps));
  oracle.write(start);
  EXPECT_FALSE(oracle.advance(steps));
  std::vector<double> state(start.size());
  oracle.read(state);
  return state;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) largest = std::max(largest, std::abs(a[n] - b[n]));
  return largest;
}

TEST(RotatingFrame, shows_the_motion_of_fixed_axes_to_the_order_of_the_method) {
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material}) {
    const Problem fixed = tumbling_body(law);
    Problem turning = fixed;
    const double end = 0.02;
    set_rotation(turning, 0.8, 12);
    const std::vector<double> start = fixture::random_state(fixed, 11, 1e-3, 0.05, 2);
    const std::vector<double> exact = seen_from_frame(turning, ran(fixed, start, end, 6400), end),
                              seen = seen_from_frame(turning, start, 0);
    const double coarse = distance(ran(turning, seen, end, 400), exact),
                 fine = distance(ran(turning, seen, end, 800), exact);
    EXPECT_LE(fine, 1e-6) << int(law);
    EXPECT_NEAR(std::log2(coarse / fine), 4, 0.3) << int(law) << ": " << coarse << ' ' << fine;
  }
}

TEST(RotatingFrame, does_the_work_that_its_energy_gains) {
  Problem problem = tumbling_body(LinkLaw::material);
  problem.bodies[0].axis[0].d_normal = 0;
  set_rotation(problem, 0.5, 3);
  const std::vector<double> start = seen_from_frame(problem, fixture::rest(problem), 0);
  const double end = 0.1, dt = 1e-4;
  Oracle<double> oracle(problem, *find_method("rk4"), dt);
  oracle.write(start);
  EnergyBalance balance(problem, Rotation::quaternion, start, 0, true);
  std::vector<double> state(start.size());
  for (long step = 1; double(step) * dt <= end; ++step) {
    ASSERT_FALSE(oracle.advance(1));
    oracle.read(state);
    balance.look(state, double(step) * dt);
  }
  const EnergyShares shares = balance.shares();
  EXPECT_GT(std::abs(shares.work), 1e-3 * shares.end);
  EXPECT_LE(std::abs(shares.error), 1e-4);
}

TEST(RotatingFrame, has_no_balance_if_it_turns_far_between_looks) {
  Problem problem = tumbling_body(LinkLaw::material);
  set_rotation(problem, 0.3, 40);
  const std::vector<double> start = seen_from_frame(problem, fixture::rest(problem), 0);
  Oracle<double> oracle(problem, *find_method("rk4"), 1e-4);
  oracle.write(start);
  EnergyBalance balance(problem, Rotation::quaternion, start, 0, false);
  std::vector<double> state(start.size());
  for (int look = 1; look <= 4; ++look) {
    ASSERT_FALSE(oracle.advance(150));
    oracle.read(state);
    balance.look(state, look * 150 * 1e-4);
  }
  EXPECT_FALSE(balance.shares().is_resolved);
}

TEST(RotatingFrame, pulls_on_clamps_by_its_centrifugal_force) {
  Problem problem = tumbling_body(LinkLaw::material);
  problem.frame_acceleration[2] = no_signal();
  problem.frame_rotation[2] = spin_up(9);
  Vector3d expected = Vector3d::Zero();
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const Vec3 rest = rest_position(problem, row, x);
    expected -= problem.bodies[0].mass * 81 * Vector3d(rest[0], rest[1], 0);
    problem.clamps.push_back({e, dof_all});
  });
  const auto found = energy_and_reactions(problem, fixture::rest(problem), Rotation::quaternion,
                                          signals_at(problem, 0.4));
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(found.reactions->force[std::size_t(axis)], expected[axis], 1e-11);
}

TEST(RotatingFrame, has_no_state_of_rest_and_no_smaller_model) {
  Problem problem = tumbling_body(LinkLaw::material);
  problem.frame_rotation[1] = spin_up(1);
  EXPECT_THROW(StaticSystem{problem}, InputError);
  for (const Model model : models)
    EXPECT_EQ(why_not(model, problem).empty(), model == Model::spatial) << name(model);
}

} // namespace
} // namespace dss
