/// What members of a hybrid do apart from computing: they keep in balance, and end together.
#include "solver/numerics/stability.hpp"
#include "tests/equivalence/hybrid_run.hpp"

namespace dss::test {
namespace {

TEST(Balance, moves_only_by_lasting_evidence_against_the_same_member) {
  Balance balance;
  for (const std::vector<double>& step_s : std::vector<std::vector<double>>{
           {1, 2}, {1, 2}, {2, 1}, {1, 2}, {1, 1.04}, {1, 2}, {1, 2}}) {
    balance.add(step_s);
    EXPECT_FALSE(balance.is_uneven());
  }
  balance.add({1, 2.3});
  EXPECT_TRUE(balance.is_uneven());
  EXPECT_NEAR(balance.step_s()[1], 2.1, 1e-12);
  const double before_s = balance.block_s();
  balance.moved();
  EXPECT_FALSE(balance.is_uneven());
  EXPECT_EQ(balance.block_s(), 2 * before_s);
}

TEST(Balance, moves_only_what_pays) {
  EXPECT_TRUE(Balance::pays(1, 0.1, 100, 9));
  EXPECT_FALSE(Balance::pays(1, 0.1, 100, 11));
  EXPECT_FALSE(Balance::pays(1, 0.01, 1e9, 0));
}

TEST_F(Hybrid, of_wrong_weights_is_balanced_within_200_steps) {
  const Problem problem = fixture::make_plate(300);
  const double seconds_an_element[] = {1e-7, 3e-7};
  for (const auto& [members, share] :
       {std::pair("avx512:1=1,avx2:1=9", 0.75), std::pair("avx512:1=9,avx2:1=1", 0.75)}) {
    const JointRun made{problem, methods().front(), members, Precision::f64,
                        [&](std::size_t m, std::size_t elements) {
                          return seconds_an_element[m] * double(elements);
                        }};
    const auto run = made.executor();
    run->write(0, State(problem.lattice.element_count * field_count, 0.0));
    run->advance(200, signal_rows(problem, methods().front(), problem.dt, 0, 200));
    const HybridInfo info = hybrid_info(*run);
    EXPECT_GE(info.rebalances, 1);
    EXPECT_NEAR(info.members[0].share, share, 0.01) << members;
    EXPECT_NEAR(info.members[0].step_s / info.members[1].step_s, 1, 0.05) << members;
    EXPECT_NEAR(info.members[0].speed, 1e7, 1) << members;
  }
}

TEST_F(Hybrid, of_unlinked_bodies_knows_its_times_and_has_the_bits_of_the_whole) {
  Problem problem = fixture::make_block(16, 12, 1, LinkLaw::paper);
  Body second = problem.bodies.front();
  second.origin = {10, 0, 0};
  fixture::add_block(problem, second, 16, 12, 1);
  const Method& method = methods().front();
  const State start = fixture::random_state(problem, 9, 1e-4, 0.02, 0.01);
  const JointRun made{problem, method, "avx512:1=1,avx2:1=1"};
  const auto run = made.executor();
  run->write(0, start);
  run->advance(100, signal_rows(problem, method, problem.dt, 0, 100));
  for (const HybridInfo::Entry& member : hybrid_info(*run).members)
    EXPECT_GT(member.step_s, 0) << member.member;
  EXPECT_EQ(differing_bits(VariantRun{plugin_of("avx512"), problem, method}.after(start, 100),
                           made.after(start, 100), Precision::f64),
            0u);
}

TEST_F(Hybrid, in_balance_or_with_noise_moves_nothing) {
  const Problem problem = fixture::make_plate(40);
  int calls = 0;
  const JointRun made{problem, methods().front(), "avx512:1=1,avx2:1=1", Precision::f64,
                      [&](std::size_t, std::size_t elements) {
                        return 1e-3 * double(elements) *
                               (calls++ % 3 == 0 ? 1.2 : 1); // the members are slow in turn
                      }};
  const auto run = made.executor();
  run->advance(400, signal_rows(problem, methods().front(), problem.dt, 0, 400));
  EXPECT_EQ(hybrid_info(*run).rebalances, 0);
}

TEST_F(Hybrid, reports_the_first_failure_of_a_single_executor) {
  const Problem problem = fixture::make_block(9, 17, 1, LinkLaw::paper);
  for (const Method& method : brief_methods()) {
    const double dt = 2 * stable_step(problem, method).dt;
    const auto failure = [&](Executor& run, long at_once) {
      run.write(0, fixture::random_state(problem, 5, 1e-20, 1e-18, 1e-18));
      for (long n = 0; n < 2000; n += at_once) {
        Outcome outcome = run.advance(at_once, signal_rows(problem, method, dt, n, at_once));
        outcome.step += n;
        if (!outcome.is_finite) return outcome;
      }
      return Outcome{};
    };
    const Outcome single = failure(
        *plugin_of("avx512").create({problem, method, Model::spatial, Precision::f64, dt}), 1);
    ASSERT_FALSE(single.is_finite) << method.name;
    for (const char* members : {"avx512:1,avx2:1", "avx2:2,avx512:1,avx2:1"})
      for (const long at_once : {1L, 7L, 2000L}) {
        const auto run =
            JointRun{problem, method, members, Precision::f64, {}, Model::spatial, dt}.executor();
        const Outcome joint = failure(*run, at_once);
        EXPECT_FALSE(joint.is_finite) << method.name << ' ' << members;
        EXPECT_EQ(joint.step, single.step) << method.name << ' ' << members << ' ' << at_once;
        EXPECT_EQ(joint.element, single.element) << method.name << ' ' << members << ' ' << at_once;
      }
  }
}

/// Gives up in the middle of its steps, while others wait for its halo.
class QuittingExecutor final : public Executor, public PartHalos {
public:
  explicit QuittingExecutor(const dss::Setup& setup)
      : width_(signal_count(setup.problem)), stages_(std::size_t(setup.method.stages)),
        right_(load_variant("avx2").create(setup)) {}
  void write(std::size_t first, std::span<const double> fields) override {
    right_->write(first, fields);
  }
  void read(std::size_t first, std::span<double> fields) override { right_->read(first, fields); }
  void derivative(std::span<const double> signals, std::span<double> rates) override {
    right_->derivative(signals, rates);
  }
  Outcome advance(long steps, std::span<const double> signals) override {
    if (steps > 3) {
      right_->advance(3, signals.first(3 * stages_ * width_ + width_));
      throw std::runtime_error("the device is lost");
    }
    return right_->advance(steps, signals);
  }
  std::string schedule() const override { return right_->schedule(); }
  int workers() const override { return right_->workers(); }
  std::size_t bytes() const override { return right_->bytes(); }
  PartHalos* part_halos() override { return this; }
  int halo_copies() const override { return dss::halo_copies(*right_); }
  HaloLayout halo_layout(std::span<const std::size_t> elements, int copy) override {
    return dss::halo_layout(*right_, elements, copy);
  }

private:
  std::size_t width_, stages_;
  std::unique_ptr<Executor> right_;
};

constexpr Plugin quitting{plugin_abi,
                          "quitting",
                          "x86-64-v3",
                          true,
                          true,
                          false,
                          [](const dss::Setup& setup) -> std::unique_ptr<Executor> {
                            return std::make_unique<QuittingExecutor>(setup);
                          },
                          nullptr};

TEST_F(Hybrid, ends_by_the_exception_of_one_member_and_does_not_wait_for_it) {
  const Problem problem = fixture::make_plate(40);
  const Method& method = methods().front();
  for (const int threads : {1, 2}) {
    JointExecutor run({problem, method, Model::spatial, Precision::f64, problem.dt},
                      {{{"avx512", "", threads}, &plugin_of("avx512")},
                       {{"quitting", "", 1}, &quitting},
                       {{"avx2", "", threads}, &load_variant("avx2")}});
    run.advance(2, signal_rows(problem, method, problem.dt, 0, 2));
    const std::vector<double> signals = signal_rows(problem, method, problem.dt, 2, 50);
    try {
      run.advance(50, signals);
      FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "the device is lost");
    }
    EXPECT_THROW(run.advance(50, signals), std::logic_error);
  }
}

/// Executors with an unknown pack width order messages by their layouts.
TEST_F(Hybrid, members_of_unknown_order_of_messages_understand_one_another) {
  const Problem problem = fixture::make_plate(31);
  const Method& method = methods().front();
  const State start = fixture::random_state(problem, 9, 1e-4, 0.02, 0.01);
  const State whole = VariantRun{plugin_of("avx512"), problem, method}.after(start, 9);
  JointExecutor run({problem, method, Model::spatial, Precision::f64, problem.dt},
                    {{{"avx512", "", 1}, &plugin_of("avx512")}, {{"quitting", "", 1}, &quitting}});
  run.write(0, start);
  for (long n = 0; n < 9; n += 3) run.advance(3, signal_rows(problem, method, problem.dt, n, 3));
  State result = poisoned(problem);
  run.read(0, result);
  EXPECT_EQ(differing_bits(whole, result, Precision::f64), 0u);
}

} // namespace
} // namespace dss::test
