/// Bounds of the errors of small rotations against errors measured by the oracle.
#include "experiments/run/model/model_monitor.hpp"
#include "solver/reference/oracle.hpp"
#include "solver/scene/scene.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

namespace dss {
namespace {

/// Runs a model and the spatial model side by side, and looks at them as rarely as a run does.
class ModelBesideTruth {
public:
  ModelBesideTruth(const Problem& problem, Model model)
      : problem_(problem), truth_(problem, method_, problem.dt),
        model_(problem, method_, problem.dt, rotation_of(model)), bound_(problem, model),
        state_(initial_state(problem)) {
    truth_.write(state_);
    model_.write(state_);
    bound_.look(state_, 0);
    largest_ = largest_of_kinds(state_);
  }
  void run(long steps) {
    long step = 0;
    for (long interval = 1; step < steps;
         interval = std::min(2 * interval, longest_look_interval(steps))) {
      const long count = std::min(interval, steps - step);
      step += count;
      ASSERT_FALSE(truth_.advance(count));
      if (model_.advance(count)) return; // not finite any more: no error to compare
      std::vector<double> expected(state_.size());
      truth_.read(expected);
      model_.read(state_);
      bound_.look(state_, double(step) * problem_.dt);
      const KindValues now = largest_of_kinds(expected);
      for (std::size_t kind = 0; kind < now.size(); ++kind)
        largest_[kind] = std::max(largest_[kind], now[kind]);
      const KindValues differences = largest_differences(expected, state_);
      error = relative_error(problem_, differences, largest_);
      estimate = relative_error(problem_, bound_.errors(), largest_);
      EXPECT_LE(error, std::max(estimate, 1e-12)) << problem_.name << " after step " << step;
    }
  }
  double error = 0, estimate = 0;

private:
  const Problem& problem_;
  const Method& method_ = *find_method("rk4");
  Oracle<double> truth_, model_;
  ModelErrorBound bound_;
  std::vector<double> state_;
  KindValues largest_{};
};

Problem ladder(const char* name, const std::vector<Override>& set = {}) {
  return load_scene(std::string(DSS_SOURCE_DIR "/experiments/scenes/ladder/") + name, set).problem;
}

void expect_bounded(const Problem& problem, Model model, long steps, double at_most_times) {
  ModelBesideTruth runs(problem, model);
  runs.run(steps);
  EXPECT_LE(runs.estimate, at_most_times * runs.error) << problem.name << " " << name(model);
}

TEST(ModelErrorBound, IsAboveTheErrorAndNotFarAboveWhereBendingIsApartFromThePlane) {
  for (const char* force : {"1e-6", "1e-3", "1"})
    expect_bounded(
        load_scene("cantilever_beam", {{"n", "8"}, {"force", force}, {"run.dt", "1e-4"}}).problem,
        Model::bending, 2000, 20);
  expect_bounded(ladder("strip.json", {{"n", "8"}}), Model::bending, 1000, 20);
  expect_bounded(load_scene("plate_bending", {{"n", "8"}}).problem, Model::bending, 1000, 30);
}

TEST(ModelErrorBound, HoldsOverManyCyclesWithoutDamping) {
  const Problem beam = load_scene("cantilever_beam", {{"n", "6"},
                                                      {"force", "1e-2"},
                                                      {"run.dt", "3e-4"},
                                                      {"bodies.0.constants.damping_ratio", "0"}})
                           .problem;
  expect_bounded(beam, Model::linear, 20000, 100);
}

TEST(ModelErrorBound, IsAboveTheErrorInThePlane) {
  for (const char* shear : {"1e-2", "1", "100"})
    expect_bounded(load_scene("plate_paper", {{"n", "8"}, {"loads.0.force.0", shear}}).problem,
                   Model::membrane, 500, 1e4);
  for (const char* side : {"1e-3", "1"})
    expect_bounded(
        load_scene(
            "cantilever_beam",
            {{"n", "8"}, {"loads.0.force.1", side}, {"loads.0.force.2", "0"}, {"run.dt", "1e-4"}})
            .problem,
        Model::membrane, 2000, 1e4);
}

constexpr double any = 1e300; ///< for cases where the bound is known to be far above

TEST(ModelErrorBound, IsAboveTheErrorWherePlanesCouple) {
  for (const Model model : {Model::linear, Model::small}) {
    expect_bounded(ladder("eccentric.json"), model, 1000, 2e4);
    expect_bounded(ladder("buckling.json"), model, 1000, any);
    expect_bounded(ladder("buckling.json", {{"load", "0.01"}, {"slight", "1e-4"}}), model, 2000,
                   1000);
    expect_bounded(
        load_scene("tumbling_box", {{"nx", "3"}, {"ny", "2"}, {"nz", "2"}, {"spin", "1e-3"}})
            .problem,
        model, 200, any);
    expect_bounded(
        load_scene("tumbling_box", {{"nx", "3"}, {"ny", "2"}, {"nz", "2"}, {"spin", "0"}}).problem,
        model, 200, any);
    expect_bounded(load_scene("block", {{"nx", "3"}, {"ny", "4"}, {"nz", "2"}}).problem, model, 500,
                   any);
  }
}

TEST(ModelErrorBound, SeesGapsWhoseCouplesAreLeftOutThoughNothingTurnsYet) {
  const Problem problem = load_scene("two_elements").problem;
  ModelErrorBound linear(problem, Model::linear), small(problem, Model::small);
  const std::vector<double> state = initial_state(problem);
  linear.look(state, 0);
  small.look(state, 0);
  EXPECT_GT(linear.errors()[0], 0.05 * linear.largest()[0]); // stretched by a tenth of an edge
  EXPECT_EQ(small.errors()[0], 0);
}

TEST(ModelErrorBound, GrowsWithWhatIsAheadAndNeverForgets) {
  Problem problem = fixture::make_tumbling_box();
  problem.initial_motions[0].angular_velocity = {0, 0, 1e-3};
  ModelErrorBound bound(problem, Model::small);
  const std::vector<double> start = initial_state(problem);
  bound.look(start, 0);
  EXPECT_EQ(bound.largest_rotation(), 0);
  EXPECT_GT(bound.errors(1)[0], bound.errors(0.1)[0]);
  EXPECT_GT(bound.errors(0.1)[0], 0);
  std::vector<double> turned = start;
  for (std::size_t e = 0; e < turned.size(); e += field_count) turned[e + qz] = 0.05;
  bound.look(turned, 1e-3);
  EXPECT_NEAR(bound.largest_rotation(), 0.1, 1e-3);
  const KindBounds turned_errors = bound.errors();
  bound.look(start, 2e-3);
  for (std::size_t kind = 0; kind < 4; ++kind) EXPECT_GE(bound.errors()[kind], turned_errors[kind]);
}

TEST(BoundStructure, TellsTreesMechanismsAndWhatIsApartFromThePlane) {
  const BoundStructure strip = bound_structure(ladder("strip.json")),
                       roll = bound_structure(ladder("roll_up.json")),
                       plate = bound_structure(load_scene("plate_bending", {{"n", "8"}}).problem),
                       box = bound_structure(fixture::make_tumbling_box());
  EXPECT_TRUE(strip.is_flat && strip.is_held && !strip.is_tree);
  EXPECT_TRUE(roll.is_flat && roll.is_held && roll.is_tree);
  EXPECT_TRUE(plate.is_flat && !plate.is_held)
      << "links without rotational stiffness are a mechanism";
  EXPECT_EQ(plate.least_buckling, 0);
  EXPECT_TRUE(!box.is_flat && !box.is_held && !box.is_tree);
  // Critical load (pi / 2 L)^2 E I of a column that is clamped at one end. Its links have 1e7 N/m^2
  // x 0.05^4 / 12 m^4. Its length is 16 x 0.05 + 2 x 0.05 m.
  const double euler = 2.4674 / (0.9 * 0.9) * 1e7 * 6.25e-6 / 12;
  EXPECT_NEAR(bound_structure(ladder("buckling.json")).least_buckling / euler, 1, 0.01);
}

} // namespace
} // namespace dss
