/// Orientations as the paper's angles, and as small rotation vectors, against quaternions.
#include "solver/model/energy.hpp"
#include "solver/reference/oracle.hpp"
#include "solver/reference/rotation_vector.hpp"
#include "solver/reference/tait_bryan.hpp"
#include "tests/fixtures/methods.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace dss {
namespace {

using reference::Orientation;
using Vector = reference::Vector<double>;
using State = std::vector<double>;

using fixture::rk4;
const Vector some_angles(0.7, -1.1, 2.3), some_spin(1.5, -0.4, 0.9);

/// The end of a run. Empty if it broke down.
std::optional<State> after(const Problem& problem, const Method& method, Rotation rotation,
                           const State& start, double dt, long steps) {
  Oracle<double> oracle(problem, method, dt, rotation);
  oracle.write(start);
  if (oracle.advance(steps)) return std::nullopt;
  State end(start.size());
  oracle.read(end);
  return end;
}

double difference(const State& a, const State& b) {
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) largest = std::max(largest, std::abs(a[n] - b[n]));
  return largest;
}

/// The same, with q and -q as the same orientation: angles cannot tell them apart.
double turned_difference(State a, const State& b) {
  for (std::size_t at = 0; at < a.size(); at += field_count) {
    double product = (1 + a[at + qs]) * (1 + b[at + qs]);
    for (const std::size_t f : {at + qx, at + qy, at + qz}) product += a[f] * b[f];
    if (product > 0) continue;
    a[at + qs] = -2 - a[at + qs];
    for (const std::size_t f : {at + qx, at + qy, at + qz}) a[f] = -a[f];
  }
  return difference(a, b);
}

TEST(TaitBryan, is_the_matrix_of_the_papers_equation_2) {
  const double phi = some_angles.x(), theta = some_angles.y(), psi = some_angles.z();
  const double cf = std::cos(phi), sf = std::sin(phi), ct = std::cos(theta), st = std::sin(theta),
               cp = std::cos(psi), sp = std::sin(psi);
  reference::Matrix<double>
      paper; // with its misprint corrected (last row, first column): X Y Z is a rotation
  paper << ct * cp, -ct * sp, st, cf * sp + sf * st * cp, cf * cp - sf * st * sp, -sf * ct,
      sf * sp - cf * st * cp, sf * cp + cf * st * sp, cf * ct;
  const reference::Matrix<double> turned =
      reference::turn(reference::orientation_of_angles(some_angles));
  EXPECT_LE((turned + reference::Matrix<double>::Identity() - paper).norm(), 1e-15);
}

TEST(TaitBryan, angles_are_those_that_the_orientation_was_made_of) {
  const auto q = reference::orientation_of_angles(some_angles);
  EXPECT_LE((reference::angles_of(q) - some_angles).norm(), 1e-14);
  const Vector tiny(1e-9, -2e-9, 3e-9);
  EXPECT_LE((reference::angles_of(reference::orientation_of_angles(tiny)) - tiny).norm(), 1e-23);
}

/// d/dt of an orientation along the rates of its coordinates, by central differences.
template <class Of>
Orientation<double> slope(Of&& orientation_of, const Vector& at, const Vector& rates) {
  const double h = 1e-5;
  const auto ahead = orientation_of(Vector(at + h * rates)),
             behind = orientation_of(Vector(at - h * rates));
  return {(ahead.s - behind.s) / (2 * h), (ahead.v - behind.v) / (2 * h)};
}
double difference(const Orientation<double>& a, const Orientation<double>& b) {
  return std::hypot(a.s - b.s, (a.v - b.v).norm());
}

TEST(TaitBryan, rates_turn_the_orientation_by_the_angular_velocity) {
  const auto turned = slope(reference::orientation_of_angles<double>, some_angles,
                            reference::angle_rates(some_angles, some_spin));
  EXPECT_LE(
      difference(turned, reference::rate(reference::orientation_of_angles(some_angles), some_spin)),
      1e-9);
}

TEST(RotationVector, is_that_which_its_quaternion_was_made_of_and_has_its_rate) {
  for (const double size : {1e-9, 1e-4, 2e-3, 1.0}) {
    const Vector theta = size * some_angles;
    const auto q = reference::orientation_of_vector(theta);
    EXPECT_LE((reference::vector_of_orientation(q) - theta).norm(), 1e-15 * size + 1e-23) << size;
    const auto rate = slope(reference::orientation_of_vector<double>, theta, some_spin);
    EXPECT_LE(difference(reference::rate_along_vector(theta, some_spin), rate), 1e-9) << size;
  }
}

class EveryRotation : public testing::TestWithParam<Rotation> {};

TEST_P(EveryRotation, reads_the_quaternions_that_were_written) {
  const Problem problem = fixture::make_everything();
  const State start = fixture::random_state(problem, 5, 0.02, 1.2);
  Oracle<double> oracle(problem, rk4, problem.dt, GetParam());
  oracle.write(start);
  State state(start.size());
  oracle.read(state);
  EXPECT_LE(difference(state, start), GetParam() == Rotation::quaternion ? 0 : 1e-15);
}

TEST_P(EveryRotation, gives_rates_that_are_the_slopes_of_what_is_read) {
  const Problem problem = fixture::make_everything();
  const State start = fixture::random_state(problem, 6, 1e-3, 0.8, 0.3);
  Oracle<double> oracle(problem, rk4, 1e-7, GetParam());
  oracle.write(start);
  State rates(start.size()), end(start.size());
  oracle.derivative(0.0, rates);
  ASSERT_FALSE(oracle.advance(1));
  oracle.read(end);
  double largest = 0;
  for (const double rate : rates) largest = std::max(largest, std::abs(rate));
  for (std::size_t n = 0; n < end.size(); ++n) end[n] = (end[n] - start[n]) / 1e-7 - rates[n];
  EXPECT_LE(difference(end, fixture::rest(problem)), 1e-4 * largest);
}

TEST_P(EveryRotation, has_the_energy_that_total_energy_finds_in_what_is_read_and_keeps_it) {
  // All kinds of rotation suit an undamped body. Linear equations have an energy of their own.
  if (GetParam() == Rotation::small)
    GTEST_SKIP() << "products are kept of which the energy has only some";
  Problem problem = fixture::make_tumbling_box();
  problem.stabilization = {50, 0, 2, 0};
  const State start = fixture::random_state(problem, 8, 1e-3, 0.3, 0.1);
  Oracle<double> oracle(problem, rk4, 2e-5, GetParam());
  oracle.write(start);
  const double before = oracle.energy();
  EXPECT_NEAR(total_energy(problem, start, GetParam()) / before, 1, 1e-13);
  ASSERT_FALSE(oracle.advance(2000));
  State end(start.size());
  oracle.read(end);
  EXPECT_NEAR(total_energy(problem, end, GetParam()) / oracle.energy(), 1, 1e-12);
  EXPECT_NEAR(oracle.energy() / before, 1, 1e-9);
}

TEST_P(EveryRotation, has_the_order_of_each_method) {
  const Problem problem = fixture::make_block(2, 2, 1, LinkLaw::material);
  const State start = fixture::random_state(problem, 3, 1e-3, 0.3, 0.3);
  for (const Method* each : all_methods()) {
    const Method& method = *each;
    // Steps at which its own error shows, neither that of higher order nor rounding.
    const double dt = method.order > 5    ? 4e-3
                      : method.order == 4 ? 1.6e-3
                      : method.order == 1 ? 5e-5
                                          : 4e-4;
    const auto at = [&](int refinement) {
      const long steps = std::lround(0.04 / dt) * refinement;
      return after(problem, method, GetParam(), start, dt / refinement, steps).value_or(State{});
    };
    const State coarse = at(1), middle = at(2), fine = at(4);
    ASSERT_FALSE(coarse.empty() || middle.empty() || fine.empty()) << method.name;
    EXPECT_NEAR(std::log2(difference(coarse, middle) / difference(middle, fine)), method.order,
                0.15)
        << method.name;
  }
}

INSTANTIATE_TEST_SUITE_P(all, EveryRotation, testing::ValuesIn(rotations),
                         [](const auto& rotation) { return std::string(name(rotation.param)); });

/// A lone non-cubic box without forces.
struct LoneBox {
  Problem problem = fixture::make_block(1, 1, 1, LinkLaw::paper);
  State spinning(const Vector& w) const {
    State state = fixture::rest(problem);
    for (int axis = 0; axis < 3; ++axis) state[std::size_t(wx + axis)] = w[axis];
    return state;
  }
  State after_rk4(Rotation rotation, const State& start, double t) const {
    return after(problem, rk4, rotation, start, 2.5e-4, std::lround(t / 2.5e-4))
        .value_or(State(start.size(), 1e9));
  }
};

/// |theta| of an element [degrees].
double middle_angle(const State& state) {
  return std::abs(reference::angles_of(reference::motion_of(state.data()).q).y()) * 180 / M_PI;
}

TEST(TaitBryan,
     taken_anew_equals_quaternions_while_a_box_tumbles_past_90_degrees_and_raw_does_not) {
  const LoneBox box;
  const State start = box.spinning({3, 5, -4});
  int passes = 0;
  bool is_near = false;
  State state = start;
  for (int n = 0; n < 200; ++n) {
    state = box.after_rk4(Rotation::quaternion, state, 0.05);
    passes += !is_near && middle_angle(state) > 80;
    is_near = middle_angle(state) > 80;
  }
  EXPECT_GE(passes, 3);
  const State end = box.after_rk4(Rotation::quaternion, start, 10);
  EXPECT_LE(turned_difference(box.after_rk4(Rotation::tait_bryan, start, 10), end), 1e-9);
  EXPECT_GE(turned_difference(box.after_rk4(Rotation::tait_bryan_raw, start, 10), end), 1e-8);
}

TEST(TaitBryan, taken_anew_goes_exactly_through_90_degrees_and_raw_goes_astray) {
  const LoneBox box;
  // Reversing the angular velocity reverses a motion: from theta = 90 degrees back by a second,
  // then forward from there.
  State singular = box.spinning({-1, -3, -2});
  singular[qs] = std::sqrt(0.5) - 1;
  singular[qy] = std::sqrt(0.5);
  State start = box.after_rk4(Rotation::quaternion, singular, 1);
  for (const std::size_t f : {std::size_t(wx), std::size_t(wy), std::size_t(wz)})
    start[f] = -start[f];
  EXPECT_NEAR(middle_angle(box.after_rk4(Rotation::quaternion, start, 1)), 90, 1e-4);
  const State end = box.after_rk4(Rotation::quaternion, start, 2);
  EXPECT_LE(turned_difference(box.after_rk4(Rotation::tait_bryan, start, 2), end), 1e-9);
  EXPECT_GE(turned_difference(box.after_rk4(Rotation::tait_bryan_raw, start, 2), end), 1e-4);
}

TEST(TaitBryan, taken_anew_equals_quaternions_on_links_between_turning_elements) {
  const Problem box = fixture::make_tumbling_box();
  const State start = initial_state(box);
  const auto end = after(box, rk4, Rotation::quaternion, start, 1e-4, 5000);
  const auto angles = after(box, rk4, Rotation::tait_bryan, start, 1e-4, 5000);
  ASSERT_TRUE(end && angles);
  EXPECT_LE(turned_difference(*angles, *end), 1e-7);
}

/// A free block. Its elements are displaced, turn and spin in proportion to `size`, with rotations
/// up to `size` [rad].
double linearisation_error(double size) {
  const Problem block = fixture::make_block(2, 2, 2, LinkLaw::material, 0);
  const State start = fixture::random_state(block, 4, 0.05 * size, size, size);
  const auto exact = after(block, rk4, Rotation::quaternion, start, 1e-4, 300);
  const auto linear = after(block, rk4, Rotation::linearised, start, 1e-4, 300);
  return exact && linear ? difference(*exact, *linear) : 0;
}

TEST(Linearised, is_off_by_the_square_of_the_angle) {
  const double large = linearisation_error(0.02), middle = linearisation_error(0.01),
               small = linearisation_error(0.005);
  EXPECT_NEAR(std::log2(large / middle), 2, 0.1);
  EXPECT_NEAR(std::log2(middle / small), 2, 0.05);
  EXPECT_GT(large, 1e-4);
}

TEST(Linearised, is_linear_without_gyroscopic_terms) {
  Problem block = fixture::make_block(2, 2, 2, LinkLaw::material);
  block.bodies[0].inertia.fill(2e-3);
  const auto end_of = [&](double factor) {
    Oracle<double> oracle(block, rk4, 1e-4, Rotation::linearised);
    State state = fixture::rest(block);
    for (std::size_t e = 0; e < block.lattice.element_count; ++e) {
      state[e * field_count + ux] = 1e-3 * factor * std::sin(1.0 + double(e));
      state[e * field_count + wy] = 3 * factor * std::cos(2.0 + double(e));
    }
    oracle.write(state);
    EXPECT_FALSE(oracle.advance(200));
    return oracle.state();
  };
  const auto once = end_of(1);
  auto thousandfold = end_of(1000);
  for (double& value : thousandfold) value /= 1000;
  double largest = 0;
  for (const double value : once) largest = std::max(largest, std::abs(value));
  EXPECT_LE(difference(once, thousandfold), 1e-13 * largest);
}

TEST(Linearised, by_the_implicit_midpoint_rule_keeps_the_energy_to_rounding) {
  Problem block = fixture::make_block(2, 2, 1, LinkLaw::material, 0);
  block.bodies[0].inertia.fill(2e-3);
  const State start = fixture::random_state(block, 4, 1e-3, 0.1, 0.1);
  Oracle<double> oracle(block, *find_method("implicit_midpoint"), 5e-3, Rotation::linearised);
  oracle.write(start);
  const double energy = oracle.energy();
  ASSERT_FALSE(oracle.advance(5000));
  EXPECT_NEAR(oracle.energy() / energy, 1, 1e-11)
      << "rounding grows with the distance that the block drifts";
}

} // namespace
} // namespace dss
