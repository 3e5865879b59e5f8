/// The methods `chebyshev` and `faber` on every variant, against short steps of the oracle.
#include "solver/error.hpp"
#include "solver/numerics/stability.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"
#include "variants/leaps/leap_executor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace dss::test {
namespace {

const Method& leaps() { return *find_method("chebyshev"); }

Problem undamped(Problem problem) {
  const auto calm = [](AxisConstants& constants) {
    constants.d_normal = 0;
    constants.d_shear = constants.d_rot = {};
  };
  for (Body& body : problem.bodies) {
    for (AxisConstants& constants : body.axis) calm(constants);
    for (auto& kind : body.more_kinds)
      for (AxisConstants& constants : kind) calm(constants);
  }
  for (ExtraLink& link : problem.extra_links) calm(link.constants);
  problem.stabilization.d = problem.stabilization.d_rot = 0;
  return problem;
}

struct Case {
  const char* name;
  Problem problem;
  std::vector<Model> models;
  /// [s]: kinks of signals are at ends of steps, which resolve harmonics. 0: of the fastest motion
  double dt = 0;
};

const std::vector<Case>& damped_cases() {
  using enum Model;
  static const std::vector<Case> all = {
      {"plate", fixture::make_plate(7), {membrane, linear}},
      {"everything", fixture::make_everything(), {linear}, 5e-4},
      {"flat_everything", fixture::make_flat_everything(), {membrane}, 5e-4},
      {"across_the_plane", fixture::make_flat_everything(true), {bending}, 5e-4},
      {"free", fixture::make_tumbling_box(1), {linear}},
      {"pressed", fixture::pressed(fixture::make_everything()), {linear}, 5e-4},
      {"bar", fixture::make_block(13, 1, 1, LinkLaw::paper), {axial}}};
  return all;
}

std::vector<Case> undamped_cases() {
  std::vector<Case> all = damped_cases();
  for (Case& each : all) each.problem = undamped(std::move(each.problem));
  return all;
}

/// A random state of a model, whose clamps are displaced but do not move.
State start(const Problem& problem, Model model, unsigned seed) {
  State state = fixture::random_state(problem, seed, 2e-4, 0.02, 0.01);
  for (const Clamp& clamp : problem.clamps)
    for (int d = 0; d < 6; ++d)
      if (clamp.dofs >> d & 1)
        state[clamp.element * field_count + std::size_t(d < 3 ? vx + d : wx + d - 3)] = 0;
  return restricted(std::move(state), model);
}

double omega_of(const Problem& problem) {
  return stable_step(problem, *find_method("velocity_verlet"), true).omega_max;
}

/// The same loads without change.
Problem steady(Problem problem) {
  for (Load& load : problem.loads) load.signal = {};
  for (Signal& signal : problem.frame_acceleration) signal.kind = Signal::Kind::constant;
  return problem;
}

struct Leaping {
  const Plugin& plugin;
  const Problem& problem;
  Model model;
  double dt;
  Precision precision = Precision::f64;
  int threads = 1;

  std::unique_ptr<Executor> executor() const {
    return make_executor(plugin, {problem, leaps(), model, precision, dt, threads});
  }
  /// After calls of advance with so many steps each.
  State after(const State& state, std::span<const long> calls, Executor& run) const {
    run.write(0, state);
    long step = 0;
    for (const long steps : calls) {
      EXPECT_TRUE(run.advance(steps, signal_rows(problem, leaps(), dt, step, steps)).is_finite);
      step += steps;
    }
    State result = poisoned(problem);
    run.read(0, result);
    return result;
  }
  State after(const State& state, std::span<const long> calls) const {
    return after(state, calls, *executor());
  }
};

/// By steps that are so short that errors are those of rounding.
State exact(Problem problem, Model model, const State& state, double dt, long steps, long of_step) {
  problem.dt = dt / double(of_step);
  return oracle_after(problem, *find_method("verner8"), state, steps * of_step, model);
}

class Leaps : public testing::TestWithParam<std::string> {
protected:
  const Plugin& plugin = load_variant(GetParam());

  /// Devices compile for each problem, and hybrids compute with the kernels of others.
  bool takes(const Case& c, Model model) const {
    if (missing_term(plugin, c.problem) != nullptr) return false;
    return !is_composed(plugin) || (c.dt == 0 && model == Model::membrane);
  }
};

TEST_P(Leaps, are_exact_whatever_the_model_and_the_terms) {
  for (const Case& c : undamped_cases())
    for (const Model model : c.models) {
      if (!takes(c, model)) continue;
      const double dt = c.dt > 0 ? c.dt : 1 / omega_of(c.problem);
      const State state = start(c.problem, model, 3);
      const long calls[] = {3, 10, 10, 10, 1};
      EXPECT_LE(relative_error(Leaping{plugin, c.problem, model, dt}.after(state, calls),
                               exact(c.problem, model, state, dt, 34, c.dt > 0 ? 2 : 16)),
                1e-10)
          << c.name << ' ' << name(model);
    }
}

TEST_P(Leaps, have_few_evaluations) {
  const Problem problem = undamped(fixture::make_plate(9));
  const double omega = omega_of(problem), dt = 2 / omega;
  const State state = start(problem, Model::membrane, 5);
  const Leaping leaping{plugin, problem, Model::membrane, dt};
  for (const bool is_at_rest : {true, false}) {
    const auto run = leaping.executor();
    const std::vector<long> calls(is_at_rest ? 1 : 8, is_at_rest ? 400 : 500);
    const long steps = is_at_rest ? 400 : 4000;
    leaping.after(is_at_rest ? fixture::rest(problem) : state, calls, *run);
    EXPECT_GE(evaluations(*run), double(steps));
    EXPECT_LE(evaluations(*run), 1.3 * double(steps)) << is_at_rest;
  }
}

TEST_P(Leaps, have_the_bits_of_one_thread) {
  if (!plugin.is_threaded) GTEST_SKIP();
  const Problem problem = undamped(fixture::make_flat_everything());
  const State state = start(problem, Model::membrane, 7);
  const long calls[] = {30, 30};
  Leaping leaping{plugin, problem, Model::membrane, 2 / omega_of(problem)};
  const State expected = leaping.after(state, calls);
  leaping.threads = 3;
  EXPECT_EQ(leaping.after(state, calls), expected);
}

TEST_P(Leaps, are_as_exact_as_single_precision_is) {
  const Problem problem = undamped(fixture::make_plate(7));
  const double dt = 1 / omega_of(problem);
  const State state = start(problem, Model::membrane, 8);
  const long calls[] = {40};
  EXPECT_LE(relative_error(
                Leaping{plugin, problem, Model::membrane, dt, Precision::f32}.after(state, calls),
                exact(problem, Model::membrane, state, dt, 40, 8)),
            1e-4);
}

/// The same problems with their damping.
TEST_P(Leaps, of_damped_problems_are_steps_of_faber) {
  const auto compare = [&](const Case& c, const Problem& problem, Model model, double dt,
                           long steps, long of_step) {
    const Method method = fitted(problem, *find_method("faber"), dt);
    const State state = start(problem, model, 3);
    VariantRun run{plugin, problem, method, model};
    run.dt = dt;
    EXPECT_LE(
        relative_error(run.after(state, steps), exact(problem, model, state, dt, steps, of_step)),
        1e-10)
        << c.name << ' ' << name(model) << ' ' << method.stages << " stages";
  };
  for (const Case& c : damped_cases())
    for (const Model model : c.models) {
      if (!takes(c, model)) continue;
      if (c.dt > 0) compare(c, c.problem, model, c.dt, 24, 2);
      const Problem problem = steady(c.problem);
      for (const double phase : {2.0, 20.0})
        compare(c, problem, model, phase / omega_of(problem), long(20 / phase) + 1,
                long(8 * phase));
    }
}

TEST_P(Leaps, and_steps_of_faber_are_as_exact_as_single_precision_is) {
  const Problem problem = fixture::make_plate(7);
  const double dt = 10 / omega_of(problem);
  const Method method = fitted(problem, *find_method("faber"), dt);
  const State state = start(problem, Model::membrane, 8);
  for (const Precision precision : {Precision::f32, Precision::f32c}) {
    if (precision == Precision::f32c && !plugin.is_compensated) continue;
    VariantRun run{plugin, problem, method, Model::membrane, precision};
    run.dt = dt;
    EXPECT_LE(
        relative_error(run.after(state, 4), exact(problem, Model::membrane, state, dt, 4, 80)),
        1e-4);
  }
}

/// Variants with FMA have equal bits.
TEST_P(Leaps, have_the_bits_of_other_variants) {
  const Plugin& fastest = load_variant("auto");
  if (!plugin.has_fma || !fastest.has_fma) GTEST_SKIP();
  const Problem problem = undamped(fixture::make_plate(7));
  const State state = start(problem, Model::membrane, 9);
  const long calls[] = {10, 10};
  const double dt = 2 / omega_of(problem);
  EXPECT_EQ(differing_bits(Leaping{plugin, problem, Model::membrane, dt}.after(state, calls),
                           Leaping{fastest, problem, Model::membrane, dt}.after(state, calls),
                           Precision::f64),
            0);
}

TEST_P(Leaps, keep_a_state_at_rest_at_rest) {
  const Problem problem = undamped(fixture::make_block(5, 3, 2, LinkLaw::material));
  const long calls[] = {5, 5};
  EXPECT_EQ(
      (Leaping{plugin, problem, Model::linear, problem.dt}.after(fixture::rest(problem), calls)),
      fixture::rest(problem));
}

TEST_P(Leaps, end_at_signals_that_are_not_finite) {
  const Problem problem = undamped(fixture::make_plate(5));
  const auto run = Leaping{plugin, problem, Model::membrane, problem.dt}.executor();
  std::vector<double> signals = signal_rows(problem, leaps(), problem.dt, 0, 6);
  for (std::size_t n = signals.size() / 2; n < signals.size(); ++n) signals[n] = INFINITY;
  EXPECT_FALSE(run->advance(6, signals).is_finite);
}

INSTANTIATE_TEST_SUITE_P(
    Variants, Leaps, testing::ValuesIn([] {
      std::vector<std::string> names;
      for (const char* name : {"scalar", "avx2", "avx512", "neon", "opencl", "hybrid"})
        if (has(name)) names.emplace_back(name);
      return names;
    }()),
    name_of_variant);

TEST(Exponential, methods_refuse_what_they_do_not_solve_and_name_the_model_that_serves) {
  const Problem damped = fixture::make_plate(5), plate = undamped(damped);
  const auto why = [](const Problem& problem, Model model, Precision precision = Precision::f64) {
    return why_not_exponential(leaps(), problem, model, precision, Rotation::quaternion);
  };
  EXPECT_EQ(why(plate, Model::membrane), "");
  EXPECT_NE(why(plate, Model::spatial).find("give --model membrane"), std::string::npos);
  EXPECT_NE(why(damped, Model::membrane).find("faber"), std::string::npos);
  EXPECT_NE(why(plate, Model::membrane, Precision::f32c), "");
  EXPECT_NE(why(fixture::rotating(fixture::make_everything()), Model::linear), "");
  EXPECT_NE(
      why_not_exponential(leaps(), plate, Model::membrane, Precision::f64, Rotation::tait_bryan),
      "");
  EXPECT_EQ(why_not_exponential(methods().front(), damped, Model::spatial, Precision::f64,
                                Rotation::tait_bryan),
            "");
  EXPECT_THROW(load_variant("scalar").create({plate, leaps(), Model::membrane}), std::logic_error);
  EXPECT_THROW(
      make_executor(load_variant("scalar"), {damped, *find_method("faber"), Model::membrane}),
      std::logic_error);
  EXPECT_THROW(make_executor(load_variant("reference"), {plate, leaps(), Model::membrane}),
               InputError);
  EXPECT_THROW(make_executor(load_variant("scalar"), {damped, leaps(), Model::membrane}),
               InputError);
  EXPECT_THROW(fitted(damped, *find_method("faber"), 1), InputError);
}

} // namespace
} // namespace dss::test
