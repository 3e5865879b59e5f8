/// The variant `sparse` against the oracle, which solves the same steps from the equations of
/// motion with a derivative by differences.
#include "solver/error.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace dss::test {
namespace {

struct Case {
  const char* name;
  Problem problem;
  std::vector<Model> models;
  double gap = 0.02; ///< of random states, for the size of the elements [m]
};

const std::vector<Case>& cases() {
  using enum Model;
  static const std::vector<Case> all = {
      {"plate", fixture::make_plate(7), {membrane, linear, planar, spatial}, 1e-3},
      {"everything", fixture::make_everything(), {linear, small, spatial}},
      {"flat_everything", fixture::make_flat_everything(), {membrane, planar}},
      {"across_the_plane", fixture::make_flat_everything(true), {bending, linear}},
      {"damped_joint", fixture::make_damped_joint(), {linear, spatial}},
      {"sponge", fixture::make_sponge(7, 6, 5, LinkLaw::paper, 1), {linear}},
      {"tumbling_box", fixture::make_tumbling_box(1), {linear, spatial}},
      {"pressed", fixture::pressed(fixture::make_everything()), {linear, small, spatial}},
      {"pressed_plate", fixture::make_pressed_plate(7, 5), {membrane, planar}},
      {"masses",
       fixture::of_masses(fixture::pressed(fixture::make_everything())),
       {linear, spatial}},
      {"bar", fixture::make_block(13, 1, 1, LinkLaw::paper), {axial}},
      {"undamped", fixture::make_block(4, 3, 2, LinkLaw::material, 0), {linear, spatial}}};
  return all;
}

/// A random state whose clamps are displaced, but do not move: scenes refuse those that do.
State start(const Case& c, Model model, unsigned seed) {
  State state = fixture::random_state(c.problem, seed, c.gap * 0.01, 0.02, 0.01);
  for (const Clamp& clamp : c.problem.clamps)
    for (int d = 0; d < 6; ++d)
      if (clamp.dofs >> d & 1)
        state[clamp.element * field_count + std::size_t(d < 3 ? vx + d : wx + d - 3)] = 0;
  return restricted(std::move(state), model);
}

class Sparse : public testing::TestWithParam<Method> {
protected:
  const Plugin& plugin = load_variant("sparse");
  const Method& method = GetParam();
};

TEST_P(Sparse, agrees_with_the_oracle_after_a_run) {
  for (const Case& c : cases())
    for (const Model model : c.models)
      for (const double factor : {1.0, 30.0}) { // far above the limit of explicit methods
        Problem problem = c.problem;
        problem.dt *= factor;
        const State state = start(c, model, 2);
        const State end = VariantRun{plugin, problem, method, model}.after(state, 20);
        EXPECT_LE(relative_error(end, oracle_after(problem, method, state, 20, model)), 1e-9)
            << c.name << ' ' << name(model) << ' ' << factor;
      }
}

/// With a small step, rounding of the displacements alone would change the accelerations.
TEST_P(Sparse, goes_on_when_a_damped_motion_has_come_to_rest) {
  Problem plate = fixture::make_plate(5);
  const Case c{"plate", plate, {Model::planar}, 1e-3};
  const State state = start(c, Model::planar, 6);
  for (const double dt : {100 * plate.dt, plate.dt / 100}) {
    VariantRun run{plugin, plate, method, Model::planar};
    run.dt = dt;
    const auto executor = run.executor();
    executor->write(0, dt > plate.dt ? state : State(state.size(), 0.0));
    const Outcome outcome = executor->advance(300, signal_rows(plate, method, dt, 0, 300));
    EXPECT_TRUE(outcome.is_finite) << dt << ": step " << outcome.step;
  }
}

TEST_P(Sparse, has_the_same_bits_whether_a_run_is_split_or_not_and_after_a_write) {
  const Case c{"everything", fixture::make_everything(), {Model::linear, Model::spatial}};
  const Problem& problem = c.problem;
  for (const Model model : c.models) {
    const State state = start(c, model, 3);
    const VariantRun run{plugin, problem, method, model};
    const State split = run.after(state, 12);
    const auto executor = run.executor();
    executor->write(0, start(c, model, 4));
    executor->advance(5, signal_rows(problem, method, problem.dt, 0, 5));
    executor->write(0, state);
    executor->advance(12, signal_rows(problem, method, problem.dt, 0, 12));
    State whole = poisoned(problem);
    executor->read(0, whole);
    EXPECT_EQ(whole, split) << name(model);
  }
}

TEST_P(Sparse, keeps_a_state_at_rest_at_rest_to_the_last_bit) {
  const Problem problem = fixture::make_block(5, 3, 2, LinkLaw::material);
  const State rest(problem.lattice.element_count * field_count, 0.0);
  for (const Model model : {Model::linear, Model::spatial})
    EXPECT_EQ((VariantRun{plugin, problem, method, model}.after(rest, 20)), rest) << name(model);
}

TEST_P(Sparse, reports_the_first_step_that_fails) {
  const Problem problem = fixture::make_plate(5);
  std::vector<double> signals = signal_rows(problem, method, problem.dt, 0, 6);
  const std::size_t row = signal_count(problem) * std::size_t(method.stages);
  for (std::size_t n = 3 * row; n < 4 * row; ++n) signals[n] = INFINITY;
  for (const Model model : {Model::linear, Model::spatial}) {
    const auto run = VariantRun{plugin, problem, method, model}.executor();
    const Outcome outcome = run->advance(6, signals);
    EXPECT_FALSE(outcome.is_finite);
    EXPECT_EQ(outcome.step, 3);
    EXPECT_LT(outcome.element, problem.lattice.element_count);
  }
}

TEST_P(Sparse, has_the_order_of_its_method) {
  const Case c{"plate", fixture::make_plate(6), {Model::membrane, Model::planar}, 1e-3};
  const double dt = (method.order == 4 ? 8 : 1) * c.problem.dt;
  for (const Model model : c.models) {
    const State state = start(c, model, 5);
    const auto after = [&](int refinement) {
      VariantRun run{plugin, c.problem, method, model};
      run.dt = dt / refinement;
      return run.after(state, 40L * refinement);
    };
    const State exact = after(32);
    const double coarse = relative_error(after(1), exact), fine = relative_error(after(2), exact);
    EXPECT_NEAR(std::log2(coarse / fine), method.order, 0.25) << name(model);
  }
}

TEST_P(Sparse, refuses_what_it_does_not_compute) {
  const Problem plate = fixture::make_plate(4);
  EXPECT_THROW(plugin.create({plate, method, Model::linear, Precision::f32}), InputError);
  EXPECT_THROW(plugin.create({plate, methods().front(), Model::linear}), InputError);
}

INSTANTIATE_TEST_SUITE_P(Methods, Sparse, testing::ValuesIn(implicit_methods()),
                         [](const auto& method) { return std::string(method.param.name); });

} // namespace
} // namespace dss::test
