/// The implicit midpoint rule in the oracle has the properties that its entry in the table of
/// methods declares.
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/reference/colouring.hpp"
#include "solver/reference/implicit_midpoint.hpp"
#include "solver/reference/oracle.hpp"
#include "tests/fixtures/methods.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace dss {
namespace {

const Method& midpoint = *find_method("implicit_midpoint");
using fixture::rest;
using fixture::rk4;

template <class T>
std::vector<double> after(const Problem& problem, const Method& method,
                          const std::vector<double>& start, double dt, long steps) {
  Oracle<T> oracle(problem, method, dt);
  oracle.write(start);
  EXPECT_FALSE(oracle.advance(steps)) << problem.name << ", dt = " << dt;
  std::vector<double> state(start.size());
  oracle.read(state);
  return state;
}

double distance(const std::vector<double>& a, const std::vector<double>& b, int first_field,
                int end_field) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
    if (int(n % field_count) >= first_field && int(n % field_count) < end_field)
      sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(sum);
}

/// Order from three runs with steps dt, dt / 2, dt / 4. Each kind of field must show it.
void expect_second_order(const Problem& problem, const std::vector<double>& start, double dt,
                         long steps) {
  const auto coarse = after<long double>(problem, midpoint, start, dt, steps);
  const auto middle = after<long double>(problem, midpoint, start, dt / 2, 2 * steps);
  const auto fine = after<long double>(problem, midpoint, start, dt / 4, 4 * steps);
  const std::vector<std::pair<int, int>> kinds = {{ux, vx}, {vx, qs}, {qs, wx}, {wx, field_count}};
  for (const auto& [first, end] : kinds)
    EXPECT_NEAR(
        std::log2(distance(coarse, middle, first, end) / distance(middle, fine, first, end)), 2,
        0.1)
        << problem.name << ", fields " << first << " to " << end;
}

/// Every term, with signals that have no kinks in time: kinks would hide the order.
Problem make_smooth_everything() {
  Problem problem = fixture::make_everything();
  for (Load& load : problem.loads)
    if (load.signal.kind == Signal::Kind::ramp || load.signal.kind == Signal::Kind::table)
      load.signal.kind = {};
  return problem;
}

TEST(ImplicitMidpoint, is_second_order_on_the_papers_damped_plate) {
  const Problem plate = fixture::make_plate(5);
  expect_second_order(plate, rest(plate), 2e-7, 200);
}

TEST(ImplicitMidpoint, is_second_order_on_every_term_with_large_rotations) {
  const Problem problem = make_smooth_everything();
  expect_second_order(problem, fixture::random_state(problem, 3, 2e-3, 1.2, 0.3), 2e-4, 50);
}

TEST(ImplicitMidpoint, declares_that_no_step_is_too_long) {
  ASSERT_TRUE(midpoint.is_implicit());
  EXPECT_EQ(&midpoint, &implicit_methods().front());
  EXPECT_EQ(find_method(midpoint.name), &midpoint);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(midpoint.imaginary_limit, infinity);
  EXPECT_EQ(midpoint.real_limit, infinity);
  EXPECT_EQ(mode_step_limit(midpoint, 1e6, 0), infinity);
  EXPECT_EQ(mode_step_limit(midpoint, 0, 1e6), infinity);
  EXPECT_EQ(mode_step_limit(midpoint, 3e5, 1e6), infinity);
  for (const bool sharp : {false, true})
    EXPECT_EQ(stable_step(fixture::make_everything(), midpoint, sharp).dt, infinity);
}

/// Two elements that oscillate against each other along their link.
struct UndampedPair {
  Problem problem = fixture::make_pair(LinkLaw::paper, 0);
  double omega = std::sqrt(2 * problem.bodies[0].axis[0].k_normal / problem.bodies[0].mass);
  std::vector<double> start = std::vector<double>(2 * field_count, 0);
  UndampedPair() {
    start[ux] = -1e-6;
    start[field_count + ux] = 1e-6;
  }
};

TEST(ImplicitMidpoint, turns_a_mode_by_its_own_frequency_whatever_the_step) {
  const UndampedPair pair;
  for (const double h_omega : {0.1, 2.0, 50.0}) {
    const double dt = h_omega / pair.omega;
    const auto state = after<double>(pair.problem, midpoint, pair.start, dt, 100);
    // tan(phase / 2) = h omega / 2 for a step; the amplitude stays as at the start
    EXPECT_NEAR(state[field_count + ux] / 1e-6, std::cos(200 * std::atan(h_omega / 2)), 1e-11)
        << h_omega;
  }
}

TEST(ImplicitMidpoint, keeps_the_energy_of_an_undamped_linear_pair_over_100000_steps) {
  const UndampedPair pair;
  Oracle<double> oracle(pair.problem, midpoint, 0.5 / pair.omega);
  oracle.write(pair.start);
  const double start = oracle.energy();
  constexpr int samples = 100;
  double early = 0, late = 0;
  for (int n = 0; n < samples; ++n) {
    ASSERT_FALSE(oracle.advance(1000));
    const double error = double(oracle.energy()) / start - 1;
    ASSERT_LT(std::abs(error), 1e-12) << "after " << 1000 * (n + 1) << " steps";
    (n < samples / 2 ? early : late) += error / (samples / 2);
  }
  EXPECT_LT(std::abs(late - early), 5e-13)
      << "what rounding adds up to over 50000 steps, and no more";
}

/// Amplitude of a pair after some steps, relative to the start.
double amplitude_after(const Method& method, double h_omega, long steps) {
  const UndampedPair pair;
  Oracle<long double> oracle(pair.problem, method, h_omega / pair.omega);
  oracle.write(pair.start);
  const auto start = oracle.energy();
  EXPECT_FALSE(oracle.advance(steps)) << method.name;
  return double(std::sqrt(oracle.energy() / start));
}

TEST(ImplicitMethods, damp_a_mode_that_they_do_not_resolve_as_their_theory_says) {
  constexpr double unresolved = 1e4;
  for (const char* name : {"implicit_midpoint", "newmark"})
    EXPECT_NEAR(amplitude_after(*find_method(name), unresolved, 50), 1, 1e-9) << name;
  EXPECT_LT(amplitude_after(*find_method("sdirk4"), unresolved, 1), 1e-3);
  for (const double radius : {0.8, 0.5}) {
    const Method method = generalized_alpha(radius);
    const double early = amplitude_after(method, unresolved, 40),
                 late = amplitude_after(method, unresolved, 60);
    EXPECT_NEAR(std::pow(late / early, 1. / 20), radius, 0.05 * radius) << radius;
  }
}

TEST(ImplicitMethods, hardly_damp_a_mode_that_they_resolve) {
  for (const Method& method : implicit_methods())
    EXPECT_NEAR(amplitude_after(method, 0.1, 100), 1, method.order == 4 ? 1e-4 : 5e-3)
        << method.name;
}

TEST(ImplicitMidpoint, keeps_quaternions_of_length_one_and_the_energy_of_a_tumbling_box_bounded) {
  const Problem box = fixture::make_block(1, 1, 1, LinkLaw::paper);
  std::vector<double> start = rest(box);
  start[wx] = 3, start[wy] = 5, start[wz] = -4;
  Oracle<double> oracle(box, midpoint, 1e-2);
  oracle.write(start);
  const double energy = oracle.energy();
  double early = 0, late = 0; // largest deviations in the first and the last half
  for (int n = 0; n < 100; ++n) {
    ASSERT_FALSE(oracle.advance(100));
    const std::vector<double>& y = oracle.state();
    const double length =
        std::sqrt((1 + y[qs]) * (1 + y[qs]) + y[qx] * y[qx] + y[qy] * y[qy] + y[qz] * y[qz]);
    ASSERT_NEAR(length, 1, 1e-13);
    double& largest = n < 50 ? early : late;
    largest = std::max(largest, std::abs(double(oracle.energy()) / energy - 1));
  }
  EXPECT_LT(late, 1e-3);
  EXPECT_LT(late, 1.05 * early) << "a trend";
}

TEST(ImplicitMidpoint, is_stable_far_above_the_limits_of_explicit_methods) {
  const Problem plate = fixture::make_plate(6);
  const double dt = 300 * stable_step(plate, rk4, true).dt;
  Oracle<double> oracle(plate, midpoint, dt);
  ASSERT_FALSE(oracle.advance(400));
  std::vector<double> state = rest(plate);
  oracle.read(state);
  double largest = 0;
  for (std::size_t at = 0; at < state.size(); at += field_count)
    largest = std::max(largest, std::hypot(state[at + ux], state[at + uy]));
  EXPECT_GT(largest, 1e-9);
  EXPECT_LT(largest, 1e-6) << "the plate's displacement under its load";
}

/// A chain that is held at one end. Its middle link is a million times stiffer than the others.
Problem make_chain_with_stiff_inclusion() {
  Problem chain = fixture::make_block(2, 1, 1, LinkLaw::paper, 0);
  for (int n = 0; n < 2; ++n)
    fixture::add_block(chain, fixture::soft_body(LinkLaw::paper, 0), 2, 1, 1);
  AxisConstants inclusion = chain.bodies[0].axis[0], link = inclusion;
  inclusion.k_normal = 1e6 * link.k_normal;
  inclusion.k_shear = across(0, inclusion.k_normal);
  chain.extra_links = {{1, 2, 0, LinkLaw::paper, inclusion}, {3, 4, 0, LinkLaw::paper, link}};
  chain.clamps = {{0, dof_all}};
  return chain;
}

TEST(ImplicitMidpoint,
     follows_the_slow_motion_beside_a_stiff_inclusion_with_a_step_far_above_the_limit) {
  const Problem chain = make_chain_with_stiff_inclusion();
  std::vector<double> start = rest(chain); // pulled, without strain in the stiff link
  for (std::size_t e = 1; e < 6; ++e)
    start[e * field_count + ux] = 1e-3 * double(e < 3 ? 1 : e - 1);
  const double dt = 5e-4, limit = stable_step(chain, rk4, true).dt;
  EXPECT_GT(dt, 20 * limit);
  const auto exact = after<double>(chain, rk4, start, 1e-5, 10'000);
  const auto error = [&](double of_step) {
    const auto large_steps =
        after<double>(chain, midpoint, start, of_step, std::lround(0.1 / of_step));
    return distance(large_steps, exact, ux, vx) / distance(exact, rest(chain), ux, vx);
  };
  EXPECT_LT(error(dt), 5e-3);
  EXPECT_NEAR(std::log2(error(dt) / error(dt / 2)), 2, 0.2)
      << "the order of the slow motion, still far above the limit";
}

TEST(ImplicitMidpoint, leaves_an_unloaded_problem_at_rest_to_the_last_bit) {
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material}) {
    const Problem block = fixture::make_block(3, 3, 2, law);
    EXPECT_EQ(after<double>(block, midpoint, rest(block), block.dt, 20), rest(block));
  }
}

TEST(ImplicitMidpoint, gives_the_same_bits_whether_a_run_is_split_or_not_and_after_a_write) {
  const Problem problem = fixture::make_everything();
  const std::vector<double> start = fixture::random_state(problem, 2, 1e-3, 0.3, 0.1);
  const auto whole = after<double>(problem, midpoint, start, problem.dt, 10);
  Oracle<double> oracle(problem, midpoint, problem.dt);
  ASSERT_FALSE(oracle.advance(3)); // starts another run, which the write ends
  oracle.write(start);
  ASSERT_FALSE(oracle.advance(4));
  ASSERT_FALSE(oracle.advance(6));
  std::vector<double> split(start.size());
  oracle.read(split);
  EXPECT_EQ(split, whole);
}

TEST(ImplicitMidpoint, takes_signals_at_the_middle_of_each_step) {
  const Problem problem = fixture::make_everything();
  Oracle<double> given(problem, midpoint, problem.dt);
  const std::size_t width = signal_count(problem);
  const std::vector<double> rows = signal_rows(problem, midpoint, problem.dt, 0, 12);
  ASSERT_EQ(rows.size(), 13 * width);
  ASSERT_FALSE(given.advance(12, [&](long step, int stage) {
    return std::span(rows).subspan(std::size_t(step + stage) * width, width);
  }));
  std::vector<double> state = rest(problem);
  given.read(state);
  EXPECT_EQ(state, after<double>(problem, midpoint, rest(problem), problem.dt, 12));
}

TEST(ImplicitMidpoint, agrees_in_every_precision_to_that_precision) {
  const Problem problem = fixture::make_everything();
  const std::vector<double> start = fixture::random_state(problem, 9, 1e-2, 1, 0.5);
  const auto a = after<float>(problem, midpoint, start, problem.dt, 50);
  const auto b = after<double>(problem, midpoint, start, problem.dt, 50);
  const auto c = after<long double>(problem, midpoint, start, problem.dt, 50);
  const double size = distance(c, rest(problem), 0, field_count);
  EXPECT_LE(distance(b, c, 0, field_count), 1e-13 * size);
  EXPECT_LE(distance(a, c, 0, field_count), 1e-4 * size);
  EXPECT_GT(distance(a, c, 0, field_count), 100 * distance(b, c, 0, field_count));
}

TEST(ImplicitMidpoint, needs_few_factorisations) {
  const Problem plate = fixture::make_plate(6);
  reference::Dynamics<double> dynamics(plate);
  reference::ImplicitMidpoint<double> rule(plate, plate.dt);
  std::vector<double> state = rest(plate);
  const std::vector<double> signals = {0, 0, 0, 1};
  for (int step = 0; step < 200; ++step) ASSERT_FALSE(rule.step(dynamics, state, signals));
  EXPECT_GE(rule.factorisations(), 1);
  EXPECT_LE(rule.factorisations(), 3) << "the plate hardly leaves its linear range";
}

TEST(ImplicitMidpoint,
     names_the_step_and_the_element_whose_equations_have_no_solution_and_keeps_the_state_before) {
  const Problem pair = fixture::make_pair(LinkLaw::paper);
  Oracle<double> oracle(pair, midpoint, pair.dt);
  std::vector<double> state = rest(pair);
  state[field_count + vx] = 1;
  oracle.write(state);
  ASSERT_FALSE(oracle.advance(3));
  std::vector<double> before(state.size()), behind(state.size());
  oracle.read(before);
  const std::vector<double> signals(3, 0),
      infinite = {0, 0, std::numeric_limits<double>::infinity()};
  const auto breakdown =
      oracle.advance(5, [&](long step, int) { return std::span(step < 2 ? signals : infinite); });
  ASSERT_TRUE(breakdown);
  EXPECT_EQ(breakdown->step, 2);
  EXPECT_EQ(breakdown->element, 0u);
  EXPECT_NE(breakdown->what, Breakdown{}.what);
  EXPECT_EQ(oracle.step_count(), 5);
  oracle.read(behind);
  ASSERT_FALSE(std::ranges::any_of(behind, [](double value) { return !std::isfinite(value); }));
  EXPECT_NE(behind, before) << "two steps went well";
}

TEST(Colouring,
     puts_no_two_elements_with_a_common_neighbour_into_one_group_and_every_element_into_one) {
  for (const Problem& problem : {fixture::make_everything(), fixture::make_plate(8),
                                 fixture::make_sponge(5, 4, 3, LinkLaw::paper, 3)}) {
    const auto near = reference::neighbourhoods(problem);
    std::size_t links = 0;
    for (const auto& of_element : near) links += of_element.size() - 1;
    EXPECT_EQ(links, 2 * problem.link_count()) << problem.name;
    std::multiset<std::size_t> grouped;
    for (const auto& group : reference::colour_groups(near)) {
      std::set<std::size_t> touched;
      for (const std::size_t e : group) {
        grouped.insert(e);
        for (const std::size_t other : near[e])
          EXPECT_TRUE(touched.insert(other).second) << problem.name << ' ' << e;
      }
    }
    EXPECT_EQ(grouped.size(), near.size());
    EXPECT_EQ(std::set<std::size_t>(grouped.begin(), grouped.end()).size(), near.size());
  }
}

} // namespace
} // namespace dss
