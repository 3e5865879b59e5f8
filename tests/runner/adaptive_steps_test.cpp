/// Steps as long as the error allows: what the tolerance means for the error of a run, and what
/// happens at a jump and at the stability limit.
#include "experiments/run/timed/adaptive_steps.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/step_growth.hpp"
#include "tests/fixtures/problems.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace dss {
namespace {

/// One tried step: its length, and whether it was accepted.
struct Try {
  double time, dt;
  bool is_accepted;
};

/// Runs a problem on the reference, and keeps what it tried.
class Recorder final : public Executor, public StepTrials {
public:
  Recorder(const Problem& problem, const std::vector<double>& start)
      : own_(load_variant("reference").create({problem, dopri5_adaptive()})), problem_(problem) {
    own_->write(0, start);
  }
  void write(std::size_t first, std::span<const double> fields) override {
    own_->write(first, fields);
  }
  void read(std::size_t first, std::span<double> fields) override { own_->read(first, fields); }
  void derivative(std::span<const double> signals, std::span<double> rates) override {
    own_->derivative(signals, rates);
  }
  Outcome advance(long steps, std::span<const double> signals) override {
    return own_->advance(steps, signals);
  }
  std::string schedule() const override { return own_->schedule(); }
  int workers() const override { return 1; }
  std::size_t bytes() const override { return own_->bytes(); }
  StepMaxima try_step(double dt, std::span<const double> signals) override {
    tries.push_back({time_, dt, false});
    return adaptive(*own_).try_step(dt, signals);
  }
  StepTrials* step_trials() override { return this; }
  void accept_step() override {
    tries.back().is_accepted = true;
    time_ += tries.back().dt;
    adaptive(*own_).accept_step();
  }
  std::vector<double> state() {
    std::vector<double> fields(problem_.lattice.element_count * field_count);
    read(0, fields);
    return fields;
  }
  std::vector<Try> tries;

private:
  const std::unique_ptr<Executor> own_;
  const Problem& problem_;
  double time_ = 0;
};

/// Element 0 is held, element 1 is pulled along the link by 250 N from t = 0: m x'' + d x' + k x =
/// f.
Problem pulled_pair(double damping) {
  Problem pair = fixture::make_pair(LinkLaw::paper, damping);
  pair.clamps = {{0, dof_all}};
  pair.loads = {{{1}, {250, 0, 0}, {0, 0, 0}, {}}};
  return pair;
}
double pulled_by(const Problem& pair, double t) {
  const double k = pair.bodies[0].axis[0].k_normal, m = pair.bodies[0].mass;
  const double decay = pair.bodies[0].axis[0].d_normal / (2 * m),
               omega = std::sqrt(k / m - decay * decay);
  return 250 / k *
         (1 - std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t)));
}

TEST(AdaptiveSteps, have_an_error_in_proportion_to_the_tolerance) {
  for (const double damping : {1.0, 20.0}) {
    const Problem pair = pulled_pair(damping);
    constexpr double end = 0.2;
    std::vector<double> ratios;
    for (const double rtol : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
      Recorder run(pair, fixture::rest(pair));
      AdaptiveSteps steps(run, pair, dopri5_adaptive(), {rtol, 0}, 1e-4, end);
      ASSERT_FALSE(steps.advance_to(end)) << rtol;
      const double error = std::abs(run.state()[field_count + ux] / pulled_by(pair, end) - 1);
      ratios.push_back(error / rtol);
    }
    const auto [least, most] = std::ranges::minmax_element(ratios);
    EXPECT_LT(*most, 10 * *least) << testing::PrintToString(ratios);
    EXPECT_LT(*most, 100) << testing::PrintToString(ratios);
  }
}

TEST(AdaptiveSteps, end_where_they_should_to_the_last_bit) {
  const Problem pair = pulled_pair(1);
  Recorder run(pair, fixture::rest(pair));
  AdaptiveSteps steps(run, pair, dopri5_adaptive(), {1e-6, 0}, 1,
                      0.1); // a first step beyond the end is shortened
  for (const double stop : {1e-5, 0.03, 0.1}) ASSERT_FALSE(steps.advance_to(stop));
  EXPECT_EQ(steps.counts().accepted + steps.counts().rejected, long(run.tries.size()));
  double sum = 0;
  for (const Try& one : run.tries) sum += one.is_accepted ? one.dt : 0;
  EXPECT_NEAR(sum, 0.1, 1e-15);
  EXPECT_NEAR(run.state()[field_count + ux], pulled_by(pair, 0.1), 1e-4 * pulled_by(pair, 0.1));
}

TEST(AdaptiveSteps, are_rejected_at_a_jump_of_a_load_and_seldom_elsewhere) {
  Problem pair = pulled_pair(1);
  Signal jump;
  jump.kind = Signal::Kind::table;
  constexpr double when = 0.0513;
  jump.times = {0, when, when * (1 + 1e-12), 1};
  jump.values = {1, 1, -1, -1};
  pair.loads[0].signal = jump;
  Recorder run(pair, fixture::rest(pair));
  AdaptiveSteps steps(run, pair, dopri5_adaptive(), {1e-8, 0}, 1e-4, 0.1);
  ASSERT_FALSE(steps.advance_to(0.1));
  int at_jump = 0, elsewhere = 0;
  for (const Try& one : run.tries)
    if (!one.is_accepted) ++(one.time <= when && one.time + one.dt >= when ? at_jump : elsewhere);
  EXPECT_GE(at_jump, 3);
  EXPECT_LE(elsewhere, 2);
  double least = 1;
  for (const Try& one : run.tries)
    if (one.is_accepted && one.time < when && one.time + one.dt >= when) least = one.dt;
  EXPECT_LT(least, 0.1 * steps.counts().largest_dt) << "the jump asks for a short step";
}

/// A chain in its slowest mode needs no short steps, so only stability limits them. An elementary
/// controller oscillates there between rejection and growth (Hairer, Norsett, Wanner II, section
/// IV.2). Just above the limit amplitudes grow by 2e-4 a step, so the step falls to it slowly.
TEST(AdaptiveSteps, of_an_undamped_chain_settle_at_the_stability_limit) {
  constexpr int elements = 20;
  constexpr double end = 100;
  Problem chain = fixture::make_block(elements, 1, 1, LinkLaw::paper, 0);
  std::vector<double> start = fixture::rest(chain);
  for (std::size_t e = 0; e < elements; ++e)
    start[e * field_count + vx] = 1e-3 * std::cos(M_PI * (double(e) + 0.5) / elements);
  Recorder run(chain, start);
  AdaptiveSteps steps(run, chain, dopri5_adaptive(), {1e-2, 0}, 1e-3, end);
  ASSERT_FALSE(steps.advance_to(end));
  const double k = chain.bodies[0].axis[0].k_normal, m = chain.bodies[0].mass;
  const double highest = 2 * std::sqrt(k / m) * std::sin(M_PI * (elements - 1) / (2 * elements));
  const double limit = mode_step_limit(*find_method("dopri5"), highest, 0);
  const std::size_t first = run.tries.size() / 2,
                    last = run.tries.size() - 2; // the last steps are cut to end in time
  for (std::size_t n = first; n < last; ++n) {
    ASSERT_TRUE(run.tries[n].is_accepted) << n;
    ASSERT_NEAR(run.tries[n].dt / run.tries[n - 1].dt, 1, 0.1) << n;
  }
  const double mean = (run.tries[last].time - run.tries[first].time) / double(last - first);
  EXPECT_GT(mean, 0.95 * limit);
  EXPECT_LT(mean, 1.25 * limit);
}

TEST(AdaptiveSteps, that_would_have_to_be_too_short_are_refused_with_time_step_and_element) {
  const Problem pair = pulled_pair(1);
  std::vector<double> start = fixture::rest(pair);
  start[field_count + vx] = std::numeric_limits<double>::infinity();
  Recorder run(pair, start);
  AdaptiveSteps steps(run, pair, dopri5_adaptive(), {1e-6, 0}, 1e-3, 0.1);
  const auto why = steps.advance_to(0.1);
  ASSERT_TRUE(why);
  EXPECT_NE(why->find("at t = 0 s"), std::string::npos) << *why;
  EXPECT_NE(why->find("not finite, element "), std::string::npos) << *why;
  Recorder fine(pair, fixture::rest(pair));
  AdaptiveSteps impossible(fine, pair, dopri5_adaptive(), {1e-30, 0}, 1e-3, 0.1);
  const auto below_rounding = impossible.advance_to(0.1);
  ASSERT_TRUE(below_rounding);
  EXPECT_NE(below_rounding->find("--rtol 1e-30"), std::string::npos) << *below_rounding;
}

TEST(StepControl, cuts_grows_and_rejects_as_it_says) {
  const auto maxima = [](double error) {
    StepMaxima one;
    one.error = {error, 0, 0, 0};
    one.state = {1, 0, 0, 0};
    return one;
  };
  StepControl control({1e-3, 0}, 1, 0.1);
  EXPECT_EQ(control.step_within(10), 0.1);
  EXPECT_EQ(control.step_within(0.1), 0.1);
  EXPECT_EQ(control.step_within(0.15), 0.075); // leaves no small remainder
  EXPECT_EQ(control.step_within(0.05), 0.05);
  EXPECT_FALSE(control.accept(maxima(32e-3), 0.1)); // 32 = 2^5
  EXPECT_NEAR(control.dt(), 0.1 * 0.9 / 2, 1e-12);
  EXPECT_TRUE(control.accept(maxima(0), 0.045));
  EXPECT_NEAR(control.dt(), 0.045, 1e-12) << "grows right after a rejection";
  EXPECT_TRUE(control.accept(maxima(0), 0.045));
  EXPECT_GT(control.dt(), 0.045);
  EXPECT_LE(control.dt(), 5 * 0.045);
  const double before = control.dt();
  EXPECT_TRUE(control.accept(maxima(0.5e-3), 1e-6)); // cut short
  EXPECT_EQ(control.dt(), before);
  StepMaxima infinite = maxima(0);
  infinite.is_finite = false;
  EXPECT_FALSE(control.accept(infinite, before));
  EXPECT_NEAR(control.dt(), 0.2 * before, 1e-15);
}

} // namespace
} // namespace dss
