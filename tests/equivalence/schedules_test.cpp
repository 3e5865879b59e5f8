/// The schedules of every variant: tiles, several steps a pass, extra links, teams of threads. Each
/// must have the bits of any other, and report the same first failure.
#include "solver/numerics/stability.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <array>
#include <span>

namespace dss::test {
namespace {

/// Teams of threads are cut in the middle, where there are a load, a base acceleration and clamps.
Problem driven(Problem problem) {
  const std::size_t middle = problem.lattice.element_count / 2;
  Signal harmonic;
  harmonic.kind = Signal::Kind::harmonic;
  harmonic.frequency = 30;
  problem.loads = {{{middle, middle + 4}, {3, -1, 2}, {0, 0.1, 0}, harmonic}};
  problem.clamps = {{middle + 1, dof_all}, {middle + 7, dof_uy | dof_rx}};
  problem.frame_acceleration[1] = harmonic;
  return problem;
}

/// Numbers of threads. Sanitizers take ten times as long, and all teams run the same code.
#ifdef DSS_SANITIZED
constexpr std::array cut_teams{3}, failing_teams{3};
#else
constexpr std::array cut_teams{1, 2, 3}, failing_teams{1, 3, 7};
#endif

/// Methods that differ in more than coefficients, and in builds with all kernels every method.
std::vector<Method> failing_methods() {
#ifdef DSS_FEWER_KERNELS
  return {*find_method("rk4"), *find_method("dopri5"), *find_method("smoothed_verlet"),
          *find_method("symplectic_euler")};
#else
  return {methods().begin(), methods().end()};
#endif
}

class EverySchedule : public testing::TestWithParam<std::string> {
protected:
  const Plugin& plugin = load_variant(GetParam());
};

TEST_P(EverySchedule, has_bitwise_equal_states_for_tiles_of_any_size_and_threads) {
  if (!plugin.has_tiles || plugin.is_distributed || GetParam() == "hybrid")
    GTEST_SKIP() << "has no tiles, or parts that choose their own";
  const bool is_brief = is_composed(plugin);
  const std::vector<Problem> problems{
      fixture::make_sponge(13, 7, 8, LinkLaw::paper, 1),
      fixture::make_sponge(21, 4, 11, LinkLaw::material, 2), fixture::make_pressed_sponge(21, 5, 8),
      fixture::rotating(fixture::make_block(9, 8, 5, LinkLaw::material)),
      fixture::of_masses(fixture::make_block(9, 8, 5, LinkLaw::material))};
  for (const Problem& problem : std::span(problems).first(is_brief ? 1 : problems.size()))
    for (const auto& [method, precision] : brief_schemes()) {
      if (is_brief && (method.name != std::string("rk4") || precision != Precision::f64)) continue;
      const State state = rounded(fixture::random_state(problem, 3, 2e-4, 0.02, 0.01), precision);
      VariantRun run{plugin, problem, method, Model::spatial, precision};
      const State whole = run.after(state, 20);
      for (run.threads = 1; run.threads <= 3; run.threads += 2)
        for (const int tile : is_brief ? std::vector{2} : std::vector{1, 2, 3, 5, 1000}) {
          run.tile = tile;
          if (tile == 1 && !is_brief) {
            EXPECT_NE(run.executor()->schedule().find("tiles of 1 rows"), std::string::npos);
          }
          EXPECT_EQ(differing_bits(whole, run.after(state, 20), precision), 0u)
              << name(precision) << ' ' << method.name << ", tile " << tile << ", " << run.threads
              << " threads";
        }
    }
}

/// A plane of a plate is one row, so tiles cut rows.
TEST_P(EverySchedule, has_bitwise_equal_states_for_rows_cut_anywhere_and_threads) {
  if (!plugin.has_tiles || is_composed(plugin)) GTEST_SKIP() << "has no rows of its own";
  Problem two_plates = fixture::make_block(150, 9, 1, LinkLaw::paper);
  fixture::add_block(two_plates, fixture::soft_body(LinkLaw::paper), 333, 1, 4);
  Problem mixed = fixture::make_block(300, 12, 1, LinkLaw::material);
  fixture::mix_links(mixed);
  const std::vector<Problem> problems{driven(mixed), fixture::make_block(701, 1, 1, LinkLaw::paper),
                                      two_plates, fixture::make_pressed_plate(350, 7)};
  for (const Problem& problem : problems)
    for (const auto& [method, precision] : brief_schemes()) {
      const State state = rounded(fixture::random_state(problem, 3, 2e-4, 0.02, 0.01), precision);
      VariantRun run{plugin, problem, method, Model::spatial, precision};
      run.tile = 1000; // longer than the rows
      const State whole = run.after(state, 17), rates = run.derivative(state);
      EXPECT_EQ(run.executor()->schedule().find("tiles"), std::string::npos);
      for (const int threads : cut_teams)
        for (const int tile : {1, 40, 100}) {
          run.threads = threads;
          run.tile = tile;
          EXPECT_NE(run.executor()->schedule().find("tiles"), std::string::npos);
          EXPECT_EQ(differing_bits(whole, run.after(state, 17), precision), 0u)
              << name(precision) << ' ' << method.name << ", tile " << tile << ", " << run.threads
              << " threads";
          EXPECT_EQ(differing_bits(rates, run.derivative(state), precision), 0u);
        }
    }
}

TEST_P(EverySchedule, fills_the_packs_of_bodies_with_holes_or_short_rows) {
  if (!plugin.has_tiles || is_composed(plugin)) GTEST_SKIP() << "has no rows of its own";
  const Method& method = *find_method("rk4");
  const auto has = [&](const Problem& problem, const char* words) {
    return VariantRun{plugin, problem, method}.executor()->schedule().find(words) !=
           std::string::npos;
  };
  const Problem comb = fixture::make_comb(97, 3, 2, LinkLaw::paper),
                short_rows = fixture::make_block(3, 12, 12, LinkLaw::paper),
                plate = fixture::make_plate(40);
  const bool has_lanes = GetParam() != "scalar" && GetParam() != "scalar-native";
  EXPECT_TRUE(has(comb, "filled packs"));
  EXPECT_TRUE(has(fixture::make_sponge(9, 8, 6, LinkLaw::material, 4), "filled packs") ||
              !has_lanes);
  EXPECT_FALSE(has(plate, "filled packs"));
  EXPECT_EQ(has(short_rows, "reach 1, in place, filled packs"), has_lanes) << "merged";
}

/// So many rows that threads make several steps of a method in place in one pass: long and short
/// rows, several planes, rows without links.
std::vector<Problem> long_blocks() {
  Problem uneven = fixture::make_block(40, 24, 1, LinkLaw::paper);
  fixture::add_block(uneven, fixture::soft_body(LinkLaw::paper), 2, 200, 1);
  Problem mixed = fixture::make_block(3, 2, 100, LinkLaw::material, 0);
  fixture::mix_links(mixed);
  return {driven(fixture::make_block(3, 140, 1, LinkLaw::paper)), driven(mixed), driven(uneven),
          fixture::make_bars(9, 5, LinkLaw::paper), fixture::make_pressed_plate(5, 170)};
}

/// After 29 steps by teams of these numbers of threads. Each team continues where the last one
/// stopped.
State by_teams(const Plugin& plugin, const Problem& problem, const Scheme& scheme,
               const std::vector<int>& teams) {
  const Method& method = scheme.method;
  const auto executor = [&](int threads) {
    return plugin.create({problem, method, Model::spatial, scheme.precision, problem.dt, threads});
  };
  State state = rounded(fixture::random_state(problem, 3, 2e-4, 0.02, 0.01), scheme.precision);
  auto run = executor(teams.front());
  run->write(0, state);
  const std::vector<long> calls =
      teams.size() == 1 ? std::vector<long>{29} : std::vector<long>{1, 9, 3, 7, 9};
  long done = 0;
  for (std::size_t call = 0; call < teams.size(); ++call) {
    if (call > 0) {
      std::vector<double> kept(problem.lattice.element_count * std::size_t(kept_fields(*run)));
      run->read(0, state); // must change nothing
      save(*run, 0, kept);
      run = executor(teams[call]);
      restore(*run, 0, kept);
    }
    EXPECT_TRUE(
        run->advance(calls[call], signal_rows(problem, method, problem.dt, done, calls[call]))
            .is_finite);
    done += calls[call];
  }
  run->read(0, state);
  return state;
}

TEST_P(EverySchedule, has_bitwise_equal_states_where_threads_make_several_steps_at_once) {
  if (!plugin.is_threaded || is_composed(plugin))
    GTEST_SKIP() << "has teams of others, or makes one step a pass";
  const std::vector<Problem> problems = long_blocks();
  for (const Scheme& scheme : schemes()) {
    if (!scheme.method.is_in_place() ||
        (scheme.precision == Precision::f32c && !plugin.is_compensated))
      continue;
    const Problem& first = problems.front();
    EXPECT_NE(plugin.create({first, scheme.method, Model::spatial, scheme.precision, first.dt, 3})
                  ->schedule()
                  .find("steps a pass"),
              std::string::npos);
    for (const Problem& problem : problems) {
      const State one = by_teams(plugin, problem, scheme, {1});
      for (const auto& teams :
           {std::vector<int>{2}, std::vector<int>{3}, std::vector<int>{2, 5, 3, 1, 2}})
        EXPECT_EQ(differing_bits(one, by_teams(plugin, problem, scheme, teams), scheme.precision),
                  0u)
            << name(scheme.precision) << ' ' << scheme.method.name << ", teams of "
            << fmt::format("{}", fmt::join(teams, ", "));
    }
  }
}

/// Bodies end to end, and a link between rows that are three planes apart.
Problem bodies_end_to_end(LinkLaw law) {
  Problem problem = fixture::make_block(9, 30, 1, law);
  std::vector<std::size_t> first{0};
  for (int body = 1; body < 3; ++body) {
    first.push_back(problem.lattice.element_count);
    fixture::add_block(problem, fixture::soft_body(LinkLaw::paper, 1), 9, 24, 1);
  }
  const Body paper = fixture::soft_body(LinkLaw::paper, 1);
  const AxisConstants material = fixture::soft_body(LinkLaw::material).axis[1];
  for (std::size_t x = 0; x < 9; ++x) {
    problem.extra_links.push_back(
        {first[1] - 9 + x, first[1] + x, 1, LinkLaw::paper, paper.axis[1]});
    problem.extra_links.push_back({first[2] + x, first[2] - 9 + x, 1, LinkLaw::material, material});
  }
  // Three links of one element: their sum depends on the order.
  problem.extra_links.push_back({100, 127, 0, LinkLaw::paper, paper.axis[0]});
  problem.extra_links.push_back({128, 100, 0, LinkLaw::paper, paper.axis[0]});
  problem.extra_links.push_back({100, 101, 1, LinkLaw::material, material});
  return problem;
}

/// The same with pressures, or in the paper's law without them.
Problem driven_and_pressed(LinkLaw law) { return fixture::pressed(driven(bodies_end_to_end(law))); }

/// Side by side: rows of the second body are far from those of the first. Many threads go stage by
/// stage.
Problem pair_side_by_side(LinkLaw law) {
  Problem problem = fixture::make_sponge(9, 8, 6, law, 4);
  const std::size_t first = problem.lattice.element_count;
  fixture::add_block(problem, fixture::soft_body(LinkLaw::paper), 5, 12, 3);
  const Body paper = fixture::soft_body(LinkLaw::paper);
  for (std::size_t n = 0; n < 20; ++n)
    problem.extra_links.push_back(
        {7 * n, first + 8 * n, int(n % 3), LinkLaw::paper, paper.axis[n % 3]});
  return problem;
}

/// Where the schedule must be the wavefront, and where stage by stage.
struct LinkedCase {
  Problem problem;
  std::vector<int> wavefronts, staged, others; ///< numbers of threads; the last by the method
};

TEST_P(EverySchedule, has_bitwise_equal_states_with_extra_links_for_any_number_of_threads) {
  if (!plugin.is_threaded || is_composed(plugin)) GTEST_SKIP() << "has teams of others";
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material})
    for (const LinkedCase& c : {LinkedCase{driven(bodies_end_to_end(law)), {1, 2}, {30}, {3, 7}},
                                LinkedCase{pair_side_by_side(law), {1}, {7}, {2, 3}},
                                LinkedCase{driven_and_pressed(law), {1}, {30}, {2, 3, 7}}})
      for (const Scheme& scheme : brief_schemes()) {
        const Method& method = scheme.method;
        const Precision precision = scheme.precision;
        const State state =
            rounded(fixture::random_state(c.problem, 3, 2e-4, 0.02, 0.01), precision);
        State expected;
        const auto check = [&](int threads, const char* word) {
          VariantRun run{plugin, c.problem, method, Model::spatial, precision, threads};
          const std::string schedule = run.executor()->schedule();
          EXPECT_NE(schedule.find(word), std::string::npos) << threads << " threads: " << schedule;
          const State end = run.after(state, 20);
          if (expected.empty()) expected = end;
          EXPECT_EQ(differing_bits(expected, end, precision), 0u)
              << name(precision) << ' ' << method.name << ", " << threads << " threads, "
              << schedule;
        };
        for (const int threads : c.staged) check(threads, "stage by stage: extra links");
        for (const int threads : c.wavefronts) check(threads, ", with extra links");
        for (const int threads : c.others) check(threads, "");
      }
}

TEST_P(EverySchedule, names_no_tiles_of_linked_bodies) {
  if (!plugin.has_tiles || is_composed(plugin)) GTEST_SKIP() << "has no tiles of its own";
  const Problem problem = pair_side_by_side(LinkLaw::paper);
  const VariantRun linked{plugin, problem, *find_method("rk4"), Model::spatial};
  EXPECT_EQ(linked.executor()->schedule().find("tiles"), std::string::npos);
  EXPECT_NE(linked.executor()->schedule().find("with extra links"), std::string::npos);
}

/// Calls advance() for `at_once` steps at a time until the state is not finite. Outcome::step
/// counts from the start.
Outcome advance_until_failure(Executor& run, const Problem& problem, const Method& method,
                              double dt, long at_once) {
  for (long n = 0; n < 2000; n += at_once) {
    Outcome outcome = run.advance(at_once, signal_rows(problem, method, dt, n, at_once));
    outcome.step += n;
    if (!outcome.is_finite) return outcome;
  }
  return {};
}

TEST_P(EverySchedule, reports_the_same_first_failure_however_many_steps_and_threads) {
  std::vector<Problem> problems{fixture::make_block(9, 7, 1, LinkLaw::paper)};
  if (!is_composed(plugin)) {
    problems.push_back(fixture::make_block(9, 8, 5, LinkLaw::paper)); // swept along y
    problems.push_back(fixture::make_pressed_sponge(9, 8, 5));
    problems.back().loads.clear();
    problems.push_back(bodies_end_to_end(LinkLaw::paper));
    problems.push_back(pair_side_by_side(LinkLaw::paper)); // of many threads: stage by stage
    problems.push_back(long_blocks().front());
  }
  if (plugin.has_tiles && !is_composed(plugin)) // first, so that the last stays so
    problems.insert(problems.begin(), fixture::make_block(150, 9, 1, LinkLaw::paper));
  for (const Problem& problem : problems)
    for (const Method& method : failing_methods()) {
      if (&problem == &problems.back() && problems.size() > 1 && !method.is_in_place())
        continue; // other methods make one step a pass
      const double dt =
          8 * stable_step(problem, *find_method("rk4")).dt; // above the limit of every method
      const auto failure = [&](int threads, long at_once, int tile = 0) {
        dss::Setup setup{problem,        method, Model::spatial,
                         Precision::f64, dt,     plugin.is_threaded ? threads : 1};
        const bool has_tiles =
            plugin.has_tiles && !is_composed(plugin) && problem.extra_links.empty();
        setup.tile = has_tiles ? tile : 0;
        const auto run = plugin.create(setup);
        run->write(0, fixture::random_state(problem, 5, 1e-60, 1e-58, 1e-58));
        return advance_until_failure(*run, problem, method, dt, at_once);
      };
      const Outcome first = failure(1, 1);
      ASSERT_FALSE(first.is_finite) << method.name;
      ASSERT_GT(first.step, 4) << method.name << ": should fail after some steps, not at once";
      for (const int threads : failing_teams)
        for (const long at_once : {3L, 1000L}) {
          const Outcome other = failure(threads, at_once, threads == 1 ? 2 : 3);
          EXPECT_EQ(other.step, first.step)
              << method.name << ' ' << threads << " threads, " << at_once << " steps";
          EXPECT_EQ(other.element, first.element)
              << method.name << ' ' << threads << " threads, " << at_once << " steps";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Registry, EverySchedule, testing::ValuesIn(usable_variants()),
                         name_of_variant);

} // namespace
} // namespace dss::test
