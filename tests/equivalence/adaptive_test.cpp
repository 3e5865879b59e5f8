/// Adaptive steps: every variant takes the same steps and gives the same bits.
#include "experiments/run/timed/adaptive_steps.hpp"
#include "solver/decomposition/decomposition.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/equivalence/local_halo.hpp"
#include "tests/equivalence/opencl_run.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>
#include <thread>

namespace dss::test {
namespace {

/// The result of a run: its state, and its accepted and rejected steps.
struct AdaptiveResult {
  State state;
  long accepted = 0, rejected = 0;
  double least_dt = 0, largest_dt = 0;
};

struct AdaptiveRun {
  const Plugin& plugin;
  const Problem& problem;
  Precision precision = Precision::f64;
  Model model = Model::spatial;
  int threads = 1;
  std::string members{};
  double rtol = 1e-4; ///< above rounding, also in f32
  double end = 100 * problem.dt;

  AdaptiveResult after(const State& start) const {
    const auto run = plugin.create({problem, dopri5_adaptive(), model, precision, problem.dt,
                                    threads, nullptr, nullptr, "", members});
    run->write(0, start);
    return finish(*run, problem);
  }
  AdaptiveResult finish(Executor& run, const Problem& of) const {
    AdaptiveSteps steps(run, of, dopri5_adaptive(), {rtol, 0}, 20 * problem.dt,
                        end); // this step is rejected first
    for (const double share : {1.0 / 3, 1.0})
      if (const auto failure = steps.advance_to(share * end)) ADD_FAILURE() << *failure;
    AdaptiveResult result{poisoned(of), steps.counts().accepted, steps.counts().rejected,
                          steps.counts().least_dt, steps.counts().largest_dt};
    run.read(0, result.state);
    return result;
  }
};

struct Case {
  std::string name;
  Problem problem;
};
std::vector<Case> cases() {
  return {{"plate", fixture::make_plate(13)},
          {"everything", fixture::make_everything()},
          {"sponge", fixture::make_sponge(21, 6, 5, LinkLaw::paper, 1)},
          {"tumbling_box", fixture::make_tumbling_box(1)},
          {"pressed_plate", fixture::make_pressed_plate(9, 14)}};
}
State start_of(const Problem& problem, Precision precision) {
  const State state = fixture::random_state(problem, 4, 1e-4, 0.02, 0.01);
  return rounded(state, precision == Precision::f64 ? precision : Precision::f32);
}

void expect_same(const AdaptiveResult& expected, const AdaptiveResult& other, Precision precision) {
  EXPECT_EQ(expected.accepted, other.accepted);
  EXPECT_EQ(expected.rejected, other.rejected);
  EXPECT_EQ(expected.least_dt, other.least_dt);
  EXPECT_EQ(expected.largest_dt, other.largest_dt);
  EXPECT_EQ(differing_bits(expected.state, other.state, precision), 0u);
}

/// Calls visit(expected, run of the fastest variant, start) for every case and precision.
template <class Visit>
void each_case(Visit&& visit) {
  for (const Case& c : cases())
    for (const Precision precision : {Precision::f64, Precision::f32, Precision::f32c}) {
      SCOPED_TRACE(c.name + ' ' + std::string(name(precision)));
      const AdaptiveRun run{load_variant("auto"), c.problem, precision};
      const State start = start_of(c.problem, precision);
      const AdaptiveResult expected = run.after(start);
      EXPECT_GT(expected.rejected, 0);
      EXPECT_GT(expected.accepted, 5);
      visit(expected, run, start);
    }
}

TEST(AdaptiveSteps, of_all_variants_and_threads_are_the_same_to_the_last_bit) {
  each_case([](const AdaptiveResult& expected, AdaptiveRun run, const State& start) {
    for (const std::string& variant : usable_variants()) {
      const Plugin& plugin = load_variant(variant);
      if (!plugin.has_fma || plugin.devices != nullptr || plugin.is_distributed ||
          variant == "hybrid")
        continue;
      for (const int threads : {1, 3}) {
        SCOPED_TRACE(variant + ' ' + std::to_string(threads));
        AdaptiveRun other{plugin, run.problem, run.precision};
        other.threads = threads;
        expect_same(expected, other.after(start), run.precision);
      }
    }
  });
}

void expect_reference_agrees(const Case& c, Model model, double tolerance) {
  SCOPED_TRACE(c.name + ' ' + std::string(name(model)));
  const State start = restricted(start_of(c.problem, Precision::f64), model);
  const AdaptiveResult
      packs = AdaptiveRun{load_variant("auto"), c.problem, Precision::f64, model}.after(start),
      plain = AdaptiveRun{load_variant("reference"), c.problem, Precision::f64, model}.after(start);
  EXPECT_EQ(packs.accepted, plain.accepted);
  EXPECT_EQ(packs.rejected, plain.rejected);
  EXPECT_LT(relative_error(restricted(packs.state, model), restricted(plain.state, model)),
            tolerance);
}

TEST(AdaptiveSteps, agree_with_those_of_the_reference) {
  for (const Case& c : cases()) {
    expect_reference_agrees(c, Model::spatial, 1e-8);
#ifndef DSS_FEWER_KERNELS
    // Its rows have the stage of the error estimate apart. The estimate of the reference is that of
    // quaternions, so its steps differ a little.
    expect_reference_agrees(c, Model::small, 1e-3);
#endif
  }
}

TEST(AdaptiveSteps, of_members_of_a_hybrid_are_the_same) {
  if (!has("hybrid")) GTEST_SKIP() << "hybrid is not here";
  each_case([](const AdaptiveResult& expected, const AdaptiveRun& run, const State& start) {
    AdaptiveRun joint{load_variant("hybrid"), run.problem, run.precision};
    joint.members = "avx2=1,avx2:2=2";
    expect_same(expected, joint.after(start), run.precision);
  });
}

/// What try_step returned for steps of several lengths, of which some were accepted, and the state
/// at the end.
struct Tries {
  std::vector<StepMaxima> maxima;
  State state;
};
Tries tries_of(Executor& run, const Problem& whole, const Problem& part) {
  Tries result;
  double t = 0;
  for (int n = 0; n < 12; ++n) {
    const double dt = whole.dt * (1 + n % 3);
    result.maxima.push_back(
        adaptive(run).try_step(dt, stage_signals(part, dopri5_adaptive(), t, dt)));
    if (n % 4 == 1) continue;
    adaptive(run).accept_step();
    t += dt;
  }
  result.state = poisoned(part);
  run.read(0, result.state);
  return result;
}

Tries tries_in_parts(const AdaptiveRun& run, const State& start, int parts, bool is_every_stage,
                     bool is_overlapped) {
  const Decomposition decomposition = decompose(run.problem, "blocks", parts);
  ThreadMailboxes mailboxes;
  std::vector<Tries> own(static_cast<std::size_t>(parts));
  Tries joined{{}, poisoned(run.problem)};
  std::vector<std::thread> team;
  for (int p = 0; p < parts; ++p)
    team.emplace_back([&, p] {
      const Part part = make_part(run.problem, decomposition, p,
                                  StepSweeps(dopri5_adaptive(), run.problem).halo(is_every_stage));
      LocalHalo halo(part, mailboxes, false);
      const PartSetup setup{part, halo, is_every_stage, is_overlapped};
      const auto executor = run.plugin.create({part.problem, dopri5_adaptive(), run.model,
                                               run.precision, run.problem.dt, run.threads, &setup});
      halo.attach(*executor, run.precision);
      for (const Run& piece : part.runs)
        executor->write(piece.local, std::span(start).subspan(piece.global * field_count,
                                                              piece.count * field_count));
      own[std::size_t(p)] = tries_of(*executor, run.problem, part.problem);
      for (const Run& piece : part.runs)
        std::copy_n(&own[std::size_t(p)].state[piece.local * field_count],
                    piece.count * field_count, &joined.state[piece.global * field_count]);
    });
  for (std::thread& thread : team) thread.join();
  joined.maxima = own.front().maxima;
  for (const Tries& one : own)
    for (std::size_t n = 0; n < joined.maxima.size(); ++n) joined.maxima[n].add(one.maxima[n]);
  return joined;
}

void expect_same_tries_in_parts(const AdaptiveRun& model, AdaptiveRun run,
                                const std::vector<int>& counts) {
  const State start = start_of(model.problem, model.precision);
  const auto whole =
      model.plugin.create({model.problem, dopri5_adaptive(), model.model, model.precision});
  whole->write(0, start);
  const Tries expected = tries_of(*whole, model.problem, model.problem);
  for (const int parts : counts)
    for (const bool is_every_stage : {false, true})
      for (const bool is_overlapped : {false, true}) {
        SCOPED_TRACE(std::to_string(parts) + (is_every_stage ? " parts, every stage" : " parts") +
                     (is_overlapped ? ", overlapped" : ""));
        const Tries other = tries_in_parts(run, start, parts, is_every_stage, is_overlapped);
        EXPECT_EQ(differing_bits(expected.state, other.state, run.precision), 0u);
        for (std::size_t n = 0; n < expected.maxima.size(); ++n) {
          EXPECT_EQ(expected.maxima[n].error, other.maxima[n].error) << n;
          EXPECT_EQ(expected.maxima[n].state, other.maxima[n].state) << n;
          EXPECT_TRUE(other.maxima[n].is_finite) << n;
        }
      }
}

TEST(AdaptiveSteps, of_parts_are_those_of_the_whole) {
  for (const Case& c : cases())
    for (const Precision precision : {Precision::f64, Precision::f32c}) {
      SCOPED_TRACE(c.name + ' ' + std::string(name(precision)));
      AdaptiveRun run{load_variant("auto"), c.problem, precision};
      for (run.threads = 1; run.threads <= 2; ++run.threads)
        expect_same_tries_in_parts(run, run, {2, 3});
    }
}

TEST(AdaptiveSteps, with_one_number_that_is_not_finite_are_told_so) {
  const Problem problem = fixture::make_block(9, 3, 1, LinkLaw::paper);
  for (const std::string& variant : usable_variants()) {
    const Plugin& plugin = load_variant(variant);
    if (plugin.devices != nullptr || variant == "hybrid")
      continue; // tested below; a hybrid chooses among all members
    const auto run = plugin.create({problem, dopri5_adaptive()});
    State state(problem.lattice.element_count * field_count, 0.0);
    state[13 * field_count + uy] = std::numeric_limits<double>::infinity();
    run->write(0, state);
    EXPECT_FALSE(adaptive(*run)
                     .try_step(problem.dt, stage_signals(problem, dopri5_adaptive(), 0, problem.dt))
                     .is_finite)
        << variant;
  }
}

/// One case each, because PoCL takes seconds to compile a program.
class AdaptiveOnDevices : public OpenCl {
protected:
  static void compare(const char* variant, const Problem& problem, Precision precision, Model model,
                      int bands) {
    State start = start_of(problem, precision);
    if (model == Model::planar) start = rounded(flattened(start), Precision::f32);
    AdaptiveRun run{packs(), problem, precision, model},
        other{load_variant(variant), problem, precision, model, bands};
    expect_same(run.after(start), other.after(start), precision);
    State infinite = start;
    infinite.back() = std::numeric_limits<double>::infinity();
    const auto executor =
        other.plugin.create({problem, dopri5_adaptive(), model, precision, problem.dt, bands});
    executor->write(0, infinite);
    EXPECT_FALSE(adaptive(*executor)
                     .try_step(problem.dt, stage_signals(problem, dopri5_adaptive(), 0, problem.dt))
                     .is_finite);
  }
};

TEST_F(AdaptiveOnDevices, resident_states_take_the_same_steps) {
  compare("opencl", fixture::make_everything(), Precision::f64, Model::spatial, 2);
}
TEST_F(AdaptiveOnDevices, compensated_states_take_the_same_steps) {
  compare("opencl", fixture::make_plate(13), Precision::f32c, Model::planar, 2);
}
TEST_F(AdaptiveOnDevices, work_groups_of_a_gpu_take_the_same_steps) {
  const DeviceAs gpu("gpu");
  compare("opencl", fixture::make_plate(13), Precision::f64, Model::planar, 1);
}
TEST_F(AdaptiveOnDevices, right_hand_sides_take_the_same_steps) {
  compare("opencl-rhs", fixture::make_plate(13), Precision::f32c, Model::planar, 2);
}
TEST_F(AdaptiveOnDevices, parts_with_memory_of_their_own_are_those_of_the_whole) {
  const DeviceAs device("discrete");
  const Problem problem = fixture::make_plate(13);
  expect_same_tries_in_parts({packs(), problem}, {load_variant("opencl"), problem}, {2});
}

} // namespace
} // namespace dss::test
