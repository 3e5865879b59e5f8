/// Parts with halos that are exchanged within this process, against the whole: equal to the last
/// bit for any decomposition, schedule of exchanges and threads. dssbench verify --ranks and
/// tests/cli/ranks_test.py add messages.
#include "solver/decomposition/decomposition.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/equivalence/local_halo.hpp"
#include "tests/equivalence/opencl_run.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>
#include <set>
#include <thread>

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
          {"comb", fixture::make_comb(97, 9, 2, LinkLaw::paper)},
          {"undamped_block", fixture::make_block(6, 11, 13, LinkLaw::material, 0)},
          {"column", fixture::make_block(3, 2, 40, LinkLaw::paper)},
          {"pressed_sponge", fixture::make_pressed_sponge(21, 9, 7)},
          {"pressed_plate", fixture::make_pressed_plate(9, 40)},
          {"pressed_pair", fixture::make_pressed_pair(9, 20)},
          {"masses", fixture::of_masses(fixture::make_block(9, 8, 7, LinkLaw::material))},
          {"rotating_block", fixture::rotating(fixture::make_block(9, 8, 7, LinkLaw::material))}};
}

std::vector<Case> cases_of(const Plugin& plugin) {
  std::vector<Case> all = cases();
  std::erase_if(all, [&](const Case& c) { return missing_term(plugin, c.problem) != nullptr; });
  return all;
}
/// Of devices a few, because a launch takes as long there as a whole run here.
std::vector<Case> few_cases_of(const Plugin& plugin) {
  std::vector<Case> all = cases_of(plugin);
  const std::set<std::string> few = {"plate", "everything", "pressed_sponge", "masses",
                                     "rotating_block"};
  if (plugin.devices != nullptr)
    std::erase_if(all, [&](const Case& c) { return !few.contains(c.name); });
  return all;
}

/// Runs all parts, each in its thread. Returns the state after a run in two calls, or the
/// derivative.
struct PartsRun {
  const Plugin& plugin;
  const Problem& problem;
  const Method& method;
  Precision precision = Precision::f64;
  bool is_every_stage = false, is_overlapped = false;
  int threads = 1;
  bool has_wrong_bit = false;
  int tile = 0;
  bool has_tiles = false; ///< expected of all parts

  template <class Act>
  State run(const Decomposition& decomposition, const State& state, Act&& act) const {
    ThreadMailboxes mailboxes;
    std::vector<Part> parts;
    for (int p = 0; p < decomposition.parts; ++p)
      parts.push_back(
          make_part(problem, decomposition, p, StepSweeps(method, problem).halo(is_every_stage)));
    State result = poisoned(problem);
    std::vector<std::thread> team;
    for (const Part& part : parts)
      team.emplace_back([&] {
        LocalHalo halo(part, mailboxes, has_wrong_bit);
        const PartSetup setup{part, halo, is_every_stage, is_overlapped};
        Setup whole{part.problem, method, Model::spatial, precision, problem.dt, threads, &setup};
        whole.tile = tile;
        const auto executor = plugin.create(whole);
        if (has_tiles) {
          EXPECT_NE(executor->schedule().find("tiles of"), std::string::npos);
        }
        halo.attach(*executor, precision);
        for (const Run& run : part.runs)
          executor->write(run.local, std::span(state).subspan(run.global * field_count,
                                                              run.count * field_count));
        const State own = act(*executor, part);
        for (const Run& run : part.runs)
          std::copy_n(&own[run.local * field_count], run.count * field_count,
                      &result[run.global * field_count]);
      });
    for (std::thread& thread : team) thread.join();
    return result;
  }
  State after(const Decomposition& decomposition, const State& state, long steps) const {
    return run(decomposition, state, [&](Executor& executor, const Part& part) {
      const long first = steps / 3;
      executor.advance(first, signal_rows(problem, method, problem.dt, 0, first));
      executor.advance(steps - first,
                       signal_rows(problem, method, problem.dt, first, steps - first));
      State own = poisoned(part.problem);
      executor.read(0, own);
      return own;
    });
  }
  State derivative(const Decomposition& decomposition, const State& state) const {
    return run(decomposition, state, [&](Executor& executor, const Part& part) {
      const std::vector<double> signals = signal_rows(problem, method, problem.dt, 0, 1);
      State rates = poisoned(part.problem);
      executor.derivative(std::span(signals).first(signal_count(problem)), rates);
      return rates;
    });
  }
};

std::vector<std::string_view> usable_methods() {
  std::vector<std::string_view> names;
  for (const std::string_view name : decomposition_methods())
    if (why_no_decomposition(name).empty()) names.push_back(name);
  return names;
}

class Parts : public testing::TestWithParam<std::string> {
protected:
  const Plugin& plugin = load_variant(GetParam());
  void SetUp() override {
    if (halo_copies(*plugin.create({fixture_problem_, methods().front()})) == 0)
      GTEST_SKIP() << plugin.name << " does not compute parts";
  }

private:
  const Problem fixture_problem_ = fixture::make_plate(4);
};

/// How parts exchange their halos, and how many there are.
struct Exchange {
  int parts;
  bool is_every_stage, is_overlapped;
};
/// All ways, in an order in which any four neighbours have both values of both flags. Two, three
/// and four parts on the fastest variant, three on the others.
std::vector<Exchange> exchanges(bool is_fastest) {
  std::vector<Exchange> all;
  for (const int parts : is_fastest ? std::vector{2, 3, 4} : std::vector{3})
    for (const auto& [is_every_stage, is_overlapped] :
         {std::pair(false, false), std::pair(true, true), std::pair(false, true),
          std::pair(true, false)})
      all.push_back({parts, is_every_stage, is_overlapped});
  return all;
}

/// With all terms every exchange is run; other problems take them in turn, two for a decomposition.
TEST_P(Parts, make_up_the_whole_to_the_last_bit) {
  const bool is_on_device = plugin.devices != nullptr;
  const bool is_fastest = plugin.name == std::string_view(load_variant("auto").name);
  const std::vector<Exchange> all = exchanges(is_fastest);
  std::size_t turn = 0;
  for (const Case& c : few_cases_of(plugin))
    for (const auto& [method, precision] : is_on_device ? device_schemes() : brief_schemes()) {
      const bool is_first = precision == Precision::f64 && method.name == "rk4";
      if (is_on_device && !is_first && c.name != "everything") continue;
      const State start = rounded(fixture::random_state(c.problem, 4, 1e-4, 0.02, 0.01), precision);
      const State whole =
          VariantRun{plugin, c.problem, method, Model::spatial, precision}.after(start, 30);
      ++turn; // or each decomposition would always have the same exchanges
      for (const std::string_view how : usable_methods())
        for (std::size_t n = 0; n < (c.name == "everything" ? all.size() : 2); ++n) {
          const auto& [parts, is_every_stage, is_overlapped] = all[turn++ % all.size()];
          if (how == "strips" && std::size_t(parts) > c.problem.lattice.rows.size()) continue;
          const PartsRun run{plugin, c.problem, method, precision, is_every_stage, is_overlapped};
          EXPECT_EQ(differing_bits(whole, run.after(decompose(c.problem, how, parts), start, 30),
                                   precision),
                    0u)
              << c.name << ' ' << name(precision) << ' ' << method.name << ", " << parts << ' '
              << how << (is_every_stage ? ", every stage" : ", every step")
              << (is_overlapped ? ", overlapped" : "");
        }
    }
}

TEST_P(Parts, have_the_derivative_of_the_whole) {
  for (const Case& c : few_cases_of(plugin))
    for (const std::string_view how : usable_methods()) {
      const State start = fixture::random_state(c.problem, 5);
      const State whole = VariantRun{plugin, c.problem, methods().front()}.derivative(start);
      const State parts = PartsRun{plugin, c.problem, methods().front()}.derivative(
          decompose(c.problem, how, 3), start);
      EXPECT_EQ(differing_bits(whole, parts, Precision::f64), 0u) << c.name << ' ' << how;
    }
}

TEST_P(Parts, of_several_threads_make_up_the_whole) {
  for (const Case& c : few_cases_of(plugin))
    for (const Method& method : brief_methods())
      for (const std::string_view how : usable_methods())
        for (const bool is_every_stage : {false, true}) {
          const State start = fixture::random_state(c.problem, 6, 1e-4, 0.02, 0.01);
          const State whole = VariantRun{plugin, c.problem, method}.after(start, 12);
          const PartsRun run{plugin, c.problem, method, Precision::f64, is_every_stage, true, 3};
          EXPECT_EQ(differing_bits(whole, run.after(decompose(c.problem, how, 2), start, 12),
                                   Precision::f64),
                    0u)
              << c.name << ' ' << method.name << ' ' << how
              << (is_every_stage ? ", every stage" : "");
        }
}

TEST_P(Parts, of_a_plate_with_cut_rows_make_up_the_whole) {
  if (!plugin.has_tiles || is_composed(plugin)) GTEST_SKIP() << "has no rows of its own";
  const Problem plate = fixture::make_block(300, 60, 1, LinkLaw::paper);
  for (const auto& [method, precision] : brief_schemes()) {
    const State start = rounded(fixture::random_state(plate, 7, 1e-4, 0.02, 0.01), precision);
    const State whole =
        VariantRun{plugin, plate, method, Model::spatial, precision}.after(start, 9);
    for (const auto& [how, parts] : {std::pair("strips", 3), std::pair("blocks", 4)})
      for (const bool is_overlapped : {false, true})
        for (const int threads : {1, 2}) {
          PartsRun run{plugin, plate, method, precision, false, is_overlapped, threads};
          run.tile = 50;
          run.has_tiles = how == std::string_view("strips"); // parts of blocks may be filled
          EXPECT_EQ(
              differing_bits(whole, run.after(decompose(plate, how, parts), start, 9), precision),
              0u)
              << name(precision) << ' ' << method.name << ' ' << how << ", " << threads
              << " threads" << (is_overlapped ? ", overlapped" : "");
        }
  }
}

/// Halos then have images. Edges and rest of a part have queues of their own, if no halo element
/// lies in an own row.
TEST_F(OpenCl, parts_on_a_device_with_memory_of_its_own_make_up_the_whole) {
  const Plugin& plugin = load_variant("opencl");
  const DeviceAs device("discrete");
  const Problem problem = fixture::make_block(37, 40, 1, LinkLaw::paper),
                joint = fixture::make_everything();
  for (const Problem* const p : {&problem, &joint})
    for (const Method& method : brief_methods()) {
      const State start = fixture::random_state(*p, 4, 1e-4, 0.02, 0.01);
      const State whole = VariantRun{packs(), *p, method}.after(start, 30);
      for (const auto& [how, parts] : {std::pair("strips", 2), std::pair("blocks", 4)})
        for (const bool is_every_stage : {false, true})
          for (const bool is_overlapped : {false, true}) {
            const PartsRun run{plugin, *p, method, Precision::f64, is_every_stage, is_overlapped};
            EXPECT_EQ(differing_bits(whole, run.after(decompose(*p, how, parts), start, 30),
                                     Precision::f64),
                      0u)
                << p->name << ' ' << method.name << ' ' << how
                << (is_every_stage ? ", every stage" : "") << (is_overlapped ? ", overlapped" : "");
          }
    }
}

/// Checks that the comparison can fail.
TEST_P(Parts, with_one_bit_of_a_halo_wrong_are_noticed) {
  const Problem problem = fixture::make_plate(13);
  const State start = fixture::random_state(problem, 7, 1e-4, 0.02, 0.01);
  const State whole = VariantRun{plugin, problem, methods().front()}.after(start, 12);
  PartsRun run{plugin, problem, methods().front()};
  run.has_wrong_bit = true;
  EXPECT_GT(
      differing_bits(whole, run.after(decompose(problem, "strips", 2), start, 12), Precision::f64),
      0u);
}

INSTANTIATE_TEST_SUITE_P(Registry, Parts, testing::ValuesIn(usable_variants()), name_of_variant);

} // namespace
} // namespace dss::test
