/// A hybrid against one executor: equal to the last bit for all members and weights, also if
/// elements move in the middle of a run.
#include "tests/equivalence/hybrid_run.hpp"

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
          {"undamped_block", fixture::make_block(6, 11, 13, LinkLaw::material, 0)},
          {"pressed_plate", fixture::make_pressed_plate(9, 60)},
          {"masses", fixture::of_masses(fixture::make_block(9, 8, 7, LinkLaw::material))},
          {"rotating_block", fixture::rotating(fixture::make_block(9, 8, 7, LinkLaw::material))}};
}

TEST_F(Hybrid, members_make_up_the_whole_to_the_last_bit) {
  for (const Case& c : cases())
    for (const auto& [method, precision] : brief_schemes()) {
      const State start = rounded(fixture::random_state(c.problem, 4, 1e-4, 0.02, 0.01), precision);
      const State whole =
          VariantRun{plugin_of("avx512"), c.problem, method, Model::spatial, precision}.after(start,
                                                                                              30);
      for (const char* members : {"avx512:1,avx512:1", "avx512:1,avx2:1", "avx2:2=1,avx512:1=9",
                                  "avx2:1,avx512:1,avx2:1", "avx512:1=7,avx2:3=1,avx512:2=2"})
        EXPECT_EQ(differing_bits(whole,
                                 JointRun{c.problem, method, members, precision}.after(start, 30),
                                 precision),
                  0u)
            << c.name << ' ' << name(precision) << ' ' << method.name << ' ' << members;
    }
}

TEST_F(Hybrid, moves_elements_in_the_middle_of_a_run_without_changing_a_bit) {
  for (const Case& c : cases())
    for (const auto& [method, precision] : brief_schemes()) {
      const State start = rounded(fixture::random_state(c.problem, 5, 1e-4, 0.02, 0.01), precision);
      const State whole =
          VariantRun{plugin_of("avx512"), c.problem, method, Model::spatial, precision}.after(start,
                                                                                              150);
      for (const char* members : {"avx512:1,avx2:1", "avx2:1=5,avx512:1=1,avx2:2=1"}) {
        int rebalances = 0;
        const JointRun run{c.problem, method, members, precision,
                           swinging(int(parse_members(members).size()), 3)};
        EXPECT_EQ(differing_bits(whole, run.after(start, 150, &rebalances), precision), 0u)
            << c.name << ' ' << name(precision) << ' ' << method.name << ' ' << members;
        EXPECT_GE(rebalances, 2) << c.name << ' ' << method.name << ' ' << members;
      }
    }
}

TEST_F(Hybrid, computes_planar_models) {
  const Problem problem = fixture::make_plate(19);
  for (const Method& method : brief_methods()) {
    const State start = flattened(fixture::random_state(problem, 6, 1e-4, 0.02, 0.01));
    const State whole =
        VariantRun{plugin_of("avx512"), problem, method, Model::planar}.after(start, 100);
    const JointRun run{problem,        method,         "avx2:1,avx512:1",
                       Precision::f64, swinging(2, 3), Model::planar};
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
    run->write(first, std::span(state).subspan(first * field_count,
                                               std::min(piece, elements - first) * field_count));
  for (std::size_t first = 0; first < elements; first += piece)
    run->read(first, std::span(back).subspan(first * field_count,
                                             std::min(piece, elements - first) * field_count));
  EXPECT_EQ(back, state);
}

/// Another executor continues from what one executor keeps.
TEST_F(Hybrid, what_a_method_keeps_moves_from_executor_to_executor) {
  for (const Case& c : cases())
    for (const auto& [method, precision] : brief_schemes()) {
      const State start =
          rounded(fixture::random_state(c.problem, 10, 1e-4, 0.02, 0.01), precision);
      const VariantRun first{plugin_of("avx512"), c.problem, method, Model::spatial, precision, 2},
          second{load_variant("avx2"), c.problem, method, Model::spatial, precision};
      const auto from = first.executor(), to = second.executor();
      from->write(0, start);
      from->advance(11, signal_rows(c.problem, method, first.dt, 0, 11));
      std::vector<double> kept(c.problem.lattice.element_count * std::size_t(kept_fields(*from)));
      ASSERT_EQ(kept_fields(*from), kept_fields(*to));
      save(*from, 0, kept);
      restore(*to, 0, kept);
      for (Executor* run : {from.get(), to.get()})
        run->advance(8, signal_rows(c.problem, method, first.dt, 11, 8));
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
    const MessageOrder sent =
        message_order(from.executor(), from.part().neighbours[0].send, 0, sizeof(double));
    const auto& received = to.part().neighbours[0].receive;
    const HaloLayout layout =
        reordered(halo_layout(to.executor(), received, 1),
                  message_order(to.executor(), received, 1, sizeof(double)), sent, sizeof(double));
    return layout.pieces.size();
  };
  const std::size_t numbers = 4 * 64 * field_count;
  EXPECT_EQ(pieces("avx512", "avx512"), 1u);
  EXPECT_EQ(pieces("avx2", "avx2"), 1u);
  EXPECT_LE(pieces("avx2", "avx512"), numbers / 4);
  EXPECT_LE(pieces("avx512", "avx2"), numbers / 4);
}

} // namespace
} // namespace dss::test
