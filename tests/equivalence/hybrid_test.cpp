/// Members of a hybrid against one executor: equal to the last bit, whatever the members, the weights and the moves of elements between
/// them in the middle of a run. Times of steps are given, not measured, so that moves do not depend on the machine.
#include "solver/error.hpp"
#include "solver/numerics/stability.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"
#include "variants/hybrid/choice.hpp"
#include "variants/hybrid/hybrid.hpp"
#include "variants/hybrid/joint.hpp"

#include <gtest/gtest.h>

namespace dss::test {
namespace {

struct Case {
  std::string name;
  Problem problem;
};

std::vector<Case> cases() {
  return {{"plate", fixture::make_plate(31)},
          {"everything", fixture::make_everything()},
          {"damped_joint", fixture::make_damped_joint()},
          {"sponge", fixture::make_sponge(21, 9, 7, LinkLaw::paper, 1)},
          {"flat_sponge", fixture::make_sponge(37, 13, 1, LinkLaw::material, 3)},
          {"undamped_block", fixture::make_block(6, 11, 13, LinkLaw::material, 0)}};
}

/// Whether this build and CPU have a variant.
bool has(std::string_view name) {
  const auto found = std::ranges::find(asked_variants(), name, &VariantStatus::name);
  return found != asked_variants().end() && found->is_usable();
}

/// Members where avx512 stands for the widest packs there are.
std::string here(std::string members) {
  constexpr std::string_view widest = "avx512";
  for (std::size_t at = 0; !has(widest) && (at = members.find(widest)) != std::string::npos;)
    members.replace(at, widest.size(), "avx2");
  return members;
}
const Plugin& plugin_of(const std::string& variant) { return load_variant(here(variant)); }

std::vector<Participant> participants_of(const std::string& members) {
  std::vector<Participant> participants;
  for (const Member& member : parse_members(here(members)))
    participants.push_back({member, &load_variant(member.variant)});
  return participants;
}

/// A run on members, in two calls of advance.
struct JointRun {
  const Problem& problem;
  const Method& method;
  std::string members;
  Precision precision = Precision::f64;
  StepTime step_time{};
  Model model = Model::spatial;
  double dt = problem.dt;

  std::unique_ptr<JointExecutor> executor() const {
    return std::make_unique<JointExecutor>(Setup{problem, method, model, precision, dt}, participants_of(members),
                                           step_time);
  }
  State after(const State& state, long steps, int* rebalances = nullptr) const {
    const auto run = executor();
    run->write(0, state);
    const long first = steps / 3;
    run->advance(first, signal_rows(problem, method, dt, 0, first));
    run->advance(steps - first, signal_rows(problem, method, dt, first, steps - first));
    State result = poisoned(problem);
    run->read(0, result);
    if (rebalances != nullptr) *rebalances = run->hybrid_info().rebalances;
    return result;
  }
};

/// Seconds a step as if each member were so many times slower than the first, for as many calls; then the other way round.
StepTime swinging(int members, double slowness) {
  return [members, slowness, calls = 0](std::size_t member, std::size_t elements) mutable {
    const bool is_slow = (calls++ / (4 * members)) % 2 == 0 ? member == 0 : member != 0;
    return 1.0 * double(elements) * (is_slow ? slowness : 1);
  };
}

class Hybrid : public testing::Test {
protected:
  void SetUp() override {
    if (!has("avx2")) GTEST_SKIP() << "avx2 is not here";
  }
};

TEST_F(Hybrid, members_make_up_the_whole_to_the_last_bit) {
  for (const Case& c : cases())
    for (const Precision precision : {Precision::f64, Precision::f32})
      for (const Method& method : methods()) {
        const State start = rounded(fixture::random_state(c.problem, 4, 1e-4, 0.02, 0.01), precision);
        const State whole =
            VariantRun{plugin_of("avx512"), c.problem, method, Model::spatial, precision}.after(start, 30);
        for (const char* members : {"avx512:1,avx512:1", "avx512:1,avx2:1", "avx2:2=1,avx512:1=9",
                                    "avx2:1,avx512:1,avx2:1", "avx512:1=7,avx2:3=1,avx512:2=2"})
          EXPECT_EQ(differing_bits(whole, JointRun{c.problem, method, members, precision}.after(start, 30), precision),
                    0u)
              << c.name << ' ' << name(precision) << ' ' << method.name << ' ' << members;
      }
}

TEST_F(Hybrid, moves_elements_in_the_middle_of_a_run_without_changing_a_bit) {
  for (const Case& c : cases())
    for (const Precision precision : {Precision::f64, Precision::f32})
      for (const Method& method : methods()) {
        const State start = rounded(fixture::random_state(c.problem, 5, 1e-4, 0.02, 0.01), precision);
        const State whole =
            VariantRun{plugin_of("avx512"), c.problem, method, Model::spatial, precision}.after(start, 150);
        for (const char* members : {"avx512:1,avx2:1", "avx2:1=5,avx512:1=1,avx2:2=1"}) {
          int rebalances = 0;
          const JointRun run{c.problem, method, members, precision, swinging(int(parse_members(members).size()), 3)};
          EXPECT_EQ(differing_bits(whole, run.after(start, 150, &rebalances), precision), 0u)
              << c.name << ' ' << name(precision) << ' ' << method.name << ' ' << members;
          EXPECT_GE(rebalances, 2) << c.name << ' ' << method.name << ' ' << members;
        }
      }
}

TEST_F(Hybrid, computes_planar_models) {
  const Problem problem = fixture::make_plate(19);
  for (const Method& method : methods()) {
    const State start = flattened(fixture::random_state(problem, 6, 1e-4, 0.02, 0.01));
    const State whole = VariantRun{plugin_of("avx512"), problem, method, Model::planar}.after(start, 100);
    const JointRun run{problem, method, "avx2:1,avx512:1", Precision::f64, swinging(2, 3), Model::planar};
    EXPECT_EQ(differing_bits(whole, run.after(start, 100), Precision::f64), 0u) << method.name;
  }
}

TEST_F(Hybrid, has_the_derivative_of_the_whole) {
  for (const Case& c : cases()) {
    const State start = fixture::random_state(c.problem, 5);
    const Method& method = methods().front();
    const State whole = VariantRun{plugin_of("avx512"), c.problem, method}.derivative(start);
    const auto run = JointRun{c.problem, method, "avx2:1,avx512:1,avx512:1"}.executor();
    run->write(0, start);
    State rates = poisoned(c.problem);
    const std::vector<double> signals = signal_rows(c.problem, method, c.problem.dt, 0, 1);
    run->derivative(std::span(signals).first(signal_count(c.problem)), rates);
    EXPECT_EQ(differing_bits(whole, rates, Precision::f64), 0u) << c.name;
  }
}

TEST_F(Hybrid, is_read_and_written_piece_by_piece) {
  const Problem problem = fixture::make_plate(12);
  const State state = fixture::random_state(problem, 8);
  const auto run = JointRun{problem, methods().front(), "avx2:1,avx512:1"}.executor();
  constexpr std::size_t piece = 7;
  State back = poisoned(problem);
  const std::size_t elements = problem.lattice.element_count;
  for (std::size_t first = 0; first < elements; first += piece)
    run->write(first, std::span(state).subspan(first * field_count, std::min(piece, elements - first) * field_count));
  for (std::size_t first = 0; first < elements; first += piece)
    run->read(first, std::span(back).subspan(first * field_count, std::min(piece, elements - first) * field_count));
  EXPECT_EQ(back, state);
}

TEST_F(Hybrid, of_wrong_weights_is_balanced_within_200_steps) {
  const Problem problem = fixture::make_plate(300);
  const double seconds_an_element[] = {1e-7, 3e-7};
  for (const auto& [members, share] :
       {std::pair("avx512:1=1,avx2:1=9", 0.75), std::pair("avx512:1=9,avx2:1=1", 0.75)}) {
    const JointRun made{problem, methods().front(), members, Precision::f64,
                        [&](std::size_t m, std::size_t elements) { return seconds_an_element[m] * double(elements); }};
    const auto run = made.executor();
    run->write(0, State(problem.lattice.element_count * field_count, 0.0));
    run->advance(200, signal_rows(problem, methods().front(), problem.dt, 0, 200));
    const HybridInfo info = run->hybrid_info();
    EXPECT_GE(info.rebalances, 1);
    EXPECT_NEAR(info.members[0].share, share, 0.01) << members;
    EXPECT_NEAR(info.members[0].step_s / info.members[1].step_s, 1, 0.05) << members;
    EXPECT_NEAR(info.members[0].speed, 1e7, 1) << members;
  }
}

TEST_F(Hybrid, in_balance_or_with_noise_moves_nothing) {
  const Problem problem = fixture::make_plate(40);
  int calls = 0;
  const JointRun made{problem, methods().front(), "avx512:1=1,avx2:1=1", Precision::f64,
                      [&](std::size_t, std::size_t elements) {
                        return 1e-3 * double(elements) * (calls++ % 3 == 0 ? 1.2 : 1); // now the one, now the other
                      }};
  const auto run = made.executor();
  run->advance(400, signal_rows(problem, methods().front(), problem.dt, 0, 400));
  EXPECT_EQ(run->hybrid_info().rebalances, 0);
}

TEST_F(Hybrid, reports_the_first_failure_of_a_single_executor) {
  const Problem problem = fixture::make_block(9, 17, 1, LinkLaw::paper);
  for (const Method& method : methods()) {
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
    const Outcome single =
        failure(*plugin_of("avx512").create({problem, method, Model::spatial, Precision::f64, dt}), 1);
    ASSERT_FALSE(single.is_finite) << method.name;
    for (const char* members : {"avx512:1,avx2:1", "avx2:2,avx512:1,avx2:1"})
      for (const long at_once : {1L, 7L, 2000L}) {
        const auto run = JointRun{problem, method, members, Precision::f64, {}, Model::spatial, dt}.executor();
        const Outcome joint = failure(*run, at_once);
        EXPECT_FALSE(joint.is_finite) << method.name << ' ' << members;
        EXPECT_EQ(joint.step, single.step) << method.name << ' ' << members << ' ' << at_once;
        EXPECT_EQ(joint.element, single.element) << method.name << ' ' << members << ' ' << at_once;
      }
  }
}

/// Gives up in the middle of its steps, while others wait for its halo.
class QuittingExecutor final : public Executor {
public:
  explicit QuittingExecutor(const dss::Setup& setup)
      : width_(signal_count(setup.problem)), stages_(std::size_t(setup.method.stages)),
        right_(load_variant("avx2").create(setup)) {}
  void write(std::size_t first, std::span<const double> fields) override { right_->write(first, fields); }
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
  int halo_copies() const override { return right_->halo_copies(); }
  HaloLayout halo_layout(std::span<const std::size_t> elements, int copy) override {
    return right_->halo_layout(elements, copy);
  }

private:
  std::size_t width_, stages_;
  std::unique_ptr<Executor> right_;
};

constexpr Plugin quitting{
    plugin_abi,
    "quitting",
    "x86-64-v3",
    true,
    true,
    false,
    [](const dss::Setup& setup) -> std::unique_ptr<Executor> { return std::make_unique<QuittingExecutor>(setup); },
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

/// Executors of unknown pack width order messages by what their layouts say.
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

/// What one executor keeps, another goes on with.
TEST_F(Hybrid, what_a_method_keeps_moves_from_executor_to_executor) {
  for (const Case& c : cases())
    for (const Precision precision : {Precision::f64, Precision::f32})
      for (const Method& method : methods()) {
        const State start = rounded(fixture::random_state(c.problem, 10, 1e-4, 0.02, 0.01), precision);
        const VariantRun first{plugin_of("avx512"), c.problem, method, Model::spatial, precision, 2},
            second{load_variant("avx2"), c.problem, method, Model::spatial, precision};
        const auto from = first.executor(), to = second.executor();
        from->write(0, start);
        from->advance(11, signal_rows(c.problem, method, first.dt, 0, 11));
        std::vector<double> kept(c.problem.lattice.element_count * std::size_t(from->kept_fields()));
        ASSERT_EQ(from->kept_fields(), to->kept_fields());
        from->save(0, kept);
        to->restore(0, kept);
        for (Executor* run : {from.get(), to.get()}) run->advance(8, signal_rows(c.problem, method, first.dt, 11, 8));
        State expected = poisoned(c.problem), moved = expected;
        from->read(0, expected);
        to->read(0, moved);
        EXPECT_EQ(differing_bits(expected, moved, precision), 0u) << c.name << ' ' << method.name;
      }
}

TEST_F(Hybrid, messages_are_copied_in_few_pieces) {
  const Problem problem = fixture::make_plate(64);
  const dss::Setup setup{problem, methods().front(), Model::spatial, Precision::f64, problem.dt};
  const Decomposition halves = decompose(problem, "strips", 2);
  const auto pieces = [&](const char* sender, const char* receiver) {
    Exchange exchange(true);
    MemberPart from(setup, {{sender, "", 1}, &plugin_of(sender)}, halves, 0, exchange),
        to(setup, {{receiver, "", 1}, &plugin_of(receiver)}, halves, 1, exchange);
    const MessageOrder sent = message_order(from.executor(), from.part().neighbours[0].send, 0, sizeof(double));
    const auto& received = to.part().neighbours[0].receive;
    const HaloLayout layout =
        reordered(to.executor().halo_layout(received, 1), message_order(to.executor(), received, 1, sizeof(double)),
                  sent, sizeof(double));
    return layout.pieces.size();
  };
  const std::size_t numbers = 4 * 64 * field_count;
  EXPECT_EQ(pieces("avx512", "avx512"), 1u);
  EXPECT_EQ(pieces("avx2", "avx2"), 1u);
  EXPECT_LE(pieces("avx2", "avx512"), numbers / 4);
  EXPECT_LE(pieces("avx512", "avx2"), numbers / 4);
}

TEST_F(Hybrid, takes_the_members_of_its_setup_or_its_own) {
  const Problem problem = fixture::make_plate(12);
  const Method& method = methods().front();
  const State start = fixture::random_state(problem, 11, 1e-4, 0.02, 0.01);
  const State whole = VariantRun{plugin_of("avx512"), problem, method}.after(start, 30);
  for (const char* members : {"", "auto", "avx2:1", "avx2:1,avx512:1"})
    for (const int threads : {1, 2, 3, 7}) {
      dss::Setup setup{problem, method, Model::spatial, Precision::f64, problem.dt, threads};
      setup.members = here(members);
      const auto run = create_hybrid(setup);
      run->write(0, start);
      run->advance(30, signal_rows(problem, method, problem.dt, 0, 30));
      State result = poisoned(problem);
      run->read(0, result);
      EXPECT_EQ(differing_bits(whole, result, Precision::f64), 0u) << members << ' ' << threads;
      const HybridInfo info = run->hybrid_info();
      double share = 0;
      for (const auto& entry : info.members) share += entry.share;
      EXPECT_NEAR(share, 1, 1e-12) << members;
      EXPECT_EQ(info.members.size(), setup.members.empty() || setup.members.find(',') != std::string::npos ? 2u : 1u)
          << members;
      EXPECT_EQ(info.reason.empty(), setup.members != "auto") << members;
    }
}

TEST_F(Hybrid, has_no_more_members_than_rows) {
  const Problem problem = fixture::make_block(9, 2, 1, LinkLaw::paper),
                row = fixture::make_block(9, 1, 1, LinkLaw::paper);
  const auto members_on = [](const Problem& on) {
    dss::Setup setup{on, methods().front(), Model::spatial, Precision::f64, on.dt};
    setup.members = here("avx512:1,avx2:1,avx2:1");
    const auto run = create_hybrid(setup);
    run->advance(5, signal_rows(on, methods().front(), on.dt, 0, 5));
    return run->hybrid_info().members.size();
  };
  EXPECT_EQ(members_on(problem), 2u);
  EXPECT_EQ(members_on(row), 1u);
}

TEST_F(Hybrid, refuses_members_that_compute_no_parts_or_round_otherwise) {
  const Problem problem = fixture::make_plate(12);
  const auto refusal = [&](const char* members) -> std::string {
    dss::Setup setup{problem, methods().front(), Model::spatial, Precision::f64, problem.dt};
    setup.members = here(members);
    try {
      create_hybrid(setup);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("avx2:1,hybrid:1").find("hybrid has parts of its own"), std::string::npos);
  EXPECT_NE(refusal("avx2:1,avx3:1").find("\"avx3\" does not exist"), std::string::npos);
  if (has("reference")) {
    EXPECT_NE(refusal("avx2:1,reference:1").find("reference rounds otherwise"), std::string::npos);
    const dss::Setup setup{problem, methods().front(), Model::spatial, Precision::f64, problem.dt};
    const std::vector<Participant> members = {{{"avx2", "", 1}, &load_variant("avx2")},
                                              {{"reference", "", 1}, &load_variant("reference")}};
    EXPECT_THROW(make_executor(setup, members), InputError);
  }
}

/// A run of what an automatic choice leaves, from a state that is written first.
State after_choice(const Choice& choice, const dss::Setup& setup, const State& start) {
  const auto made = choice.executor ? nullptr : make_executor(setup, choice.participants);
  Executor& run = choice.executor ? *choice.executor : *made;
  run.write(0, start);
  run.advance(30, signal_rows(setup.problem, setup.method, setup.dt, 0, 30));
  State result = poisoned(setup.problem);
  run.read(0, result);
  return result;
}

TEST_F(Hybrid, auto_tries_devices_that_may_pay_and_leaves_out_those_that_cannot) {
  const Problem problem = fixture::make_plate(150);
  const Method& method = methods().front();
  const State start = fixture::random_state(problem, 12, 1e-4, 0.02, 0.01);
  const State whole = VariantRun{plugin_of("avx512"), problem, method}.after(start, 30);
  const dss::Setup setup{problem, method, Model::spatial, Precision::f64, problem.dt, 1};
  const Choice equals = choose_fastest(setup, {{{"avx2", "as fast", 1}, &load_variant("avx2")}});
  EXPECT_NE(equals.reason.find("tried: "), std::string::npos) << equals.reason;
  EXPECT_EQ(differing_bits(whole, after_choice(equals, setup, start), Precision::f64), 0u);
  if (!has("reference")) return;
  const Choice unlike = choose_fastest(setup, {{{"reference", "slow", 1}, &load_variant("reference")}});
  ASSERT_EQ(unlike.participants.size(), 1u) << unlike.reason;
  EXPECT_EQ(unlike.participants[0].member.device, "");
  EXPECT_EQ(differing_bits(whole, after_choice(unlike, setup, start), Precision::f64), 0u);
}

/// More ranks: tests/cli.
TEST_F(Hybrid, gives_members_to_ranks) {
  if (!has("mpi")) GTEST_SKIP() << "no mpi";
  const Problem problem = fixture::make_plate(12);
  const Method& method = methods().front();
  dss::Setup setup{problem, method, Model::spatial, Precision::f64, problem.dt};
  setup.members = here("avx2:2,avx512:1");
  const auto run = load_variant("mpi").create(setup);
  EXPECT_EQ(run->rank_info().variant, "avx2");
  EXPECT_EQ(run->rank_info().halo, "deep");
  EXPECT_EQ(run->workers(), 2);
  const State start = fixture::random_state(problem, 11, 1e-4, 0.02, 0.01);
  run->write(0, start);
  run->advance(30, signal_rows(problem, method, problem.dt, 0, 30));
  State result = poisoned(problem);
  run->read(0, result);
  const State whole = VariantRun{plugin_of("avx512"), problem, method}.after(start, 30);
  EXPECT_EQ(differing_bits(whole, result, Precision::f64), 0u);
  setup.members = "auto";
  EXPECT_THROW(load_variant("mpi").create(setup), InputError);
}

} // namespace
} // namespace dss::test
