#include "solver/model/energy_balance.hpp"
#include "solver/reference/oracle.hpp"
#include "tests/fixtures/methods.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace dss {
namespace {

using fixture::rk4;

/// Balance of a run by the oracle.
/// @param between  steps between looks
/// @param change   what is done to the state before a look after `step` steps; for constant
///     signals, because time restarts
EnergyShares balance_of(const Problem& problem, long steps, long between, bool follows_dampers,
                        const std::function<void(long, std::vector<double>&)>& change = {}) {
  Oracle<double> oracle(problem, rk4, problem.dt);
  std::vector<double> state = initial_state(problem);
  oracle.write(state);
  EnergyBalance balance(problem, Rotation::quaternion, state, 0, follows_dampers);
  for (long step = 0; step < steps; step += between) {
    oracle.advance(between);
    oracle.read(state);
    if (change) {
      change(step + between, state);
      oracle.write(state);
    }
    balance.look(state, double(step + between) * problem.dt);
  }
  return balance.shares();
}

TEST(EnergyBalance, closes_with_every_term_of_a_problem) {
  Problem problem = fixture::make_everything();
  problem.clamps = {{0, dof_all}};
  const EnergyShares shares = balance_of(problem, 1000, 1, true);
  EXPECT_TRUE(shares.is_complete && shares.is_resolved);
  EXPECT_LT(std::abs(shares.error), 1e-6);
  EXPECT_LT(std::abs(shares.gained()), 1e-6 * shares.end);
  EXPECT_GT(std::abs(shares.work), 0.1 * shares.end);
  EXPECT_GT(shares.dissipated, 0.02 * shares.end);
}

TEST(EnergyBalance, has_the_work_of_a_constant_force_however_far_looks_are_apart) {
  Problem block = fixture::make_block(4, 2, 1, LinkLaw::material, 0);
  block.clamps = {{0, dof_all}};
  block.loads = {{{7}, {40, -30, 20}, {}, {}}};
  const EnergyShares shares = balance_of(block, 900, 300, false);
  EXPECT_TRUE(shares.is_complete) << "nothing is damped";
  EXPECT_LT(std::abs(shares.error), 1e-4);
  EXPECT_GT(shares.work, 0.9 * shares.end);
}

TEST(EnergyBalance, sees_energy_that_appears_or_is_lost) {
  const Problem box = fixture::make_tumbling_box();
  const auto with_speeds_times = [&](double factor) {
    return balance_of(box, 100, 1, true, [&](long step, std::vector<double>& state) {
      for (std::size_t n = 0; n < state.size() && step == 50; ++n)
        if (const auto field = int(n % field_count); (field >= vx && field < qs) || field >= wx)
          state[n] *= factor;
    });
  };
  EXPECT_NEAR(with_speeds_times(1.1).error, 1 - 1 / 1.21, 0.02);
  EXPECT_NEAR(with_speeds_times(0.9).error, -0.19, 0.02);
  EXPECT_LT(std::abs(with_speeds_times(1).error), 1e-6);
}

TEST(EnergyBalance, forgets_an_error_that_dampers_have_taken) {
  Problem pair = fixture::make_pair(LinkLaw::material, 10);
  pair.clamps = {{0, dof_all}};
  pair.loads = {{{1}, {40, -30, 20}, {}, {}}};
  const auto push = [](long step, std::vector<double>& state) {
    if (step == 5) state[field_count + vx] += 10;
  };
  const EnergyShares early = balance_of(pair, 5, 1, true, push),
                     late = balance_of(pair, 20'000, 1, true, push);
  EXPECT_GT(early.error, 0.5);
  EXPECT_LT(std::abs(late.error), 0.01);
  EXPECT_GT(late.gained(), 0.5 * early.end) << "it is known that it was there";
}

TEST(EnergyBalance, is_unresolved_if_a_signal_changes_between_looks) {
  Problem block = fixture::make_block(4, 2, 1, LinkLaw::material, 0);
  block.clamps = {{0, dof_all}};
  Signal fast;
  fast.kind = Signal::Kind::harmonic;
  fast.frequency = 40;
  block.loads = {{{7}, {40, -30, 20}, {}, fast}};
  EXPECT_FALSE(balance_of(block, 1000, 100, false).is_resolved);
  EXPECT_TRUE(balance_of(block, 1000, 1, false).is_resolved);
}

TEST(EnergyBalance, is_unresolved_by_whole_periods_pulses_and_far_turns_between_looks) {
  Problem block = fixture::make_block(4, 2, 1, LinkLaw::material, 0);
  Signal harmonic, pulse;
  harmonic.kind = Signal::Kind::harmonic;
  harmonic.frequency = 2 / (400 * block.dt); // two periods: no look sees the signal
  pulse.kind = Signal::Kind::table;
  pulse.times = {0.1 * 400 * block.dt, 0.2 * 400 * block.dt, 0.3 * 400 * block.dt};
  pulse.values = {0, 1, 0};
  for (const Signal& signal : {harmonic, pulse}) {
    block.loads = {{{7}, {40, -30, 20}, {}, signal}};
    EXPECT_FALSE(balance_of(block, 400, 400, false).is_resolved);
    EXPECT_TRUE(balance_of(block, 400, 1, false).is_resolved);
  }
  Problem lone = fixture::make_block(1, 1, 1, LinkLaw::paper, 0);
  lone.loads = {{{0}, {}, {0, 0, 0.1}, {}}};
  EXPECT_FALSE(balance_of(lone, 4000, 2000, false).is_resolved);
  const EnergyShares followed = balance_of(lone, 4000, 40, false);
  EXPECT_TRUE(followed.is_resolved);
  EXPECT_LT(std::abs(followed.error), 1e-6);
}

TEST(EnergyBalance, of_damped_links_that_are_not_followed_is_an_upper_bound) {
  const EnergyShares shares = balance_of(fixture::make_tumbling_box(1), 500, 100, false);
  EXPECT_FALSE(shares.is_complete);
  EXPECT_LT(shares.error, 0);
}

} // namespace
} // namespace dss
