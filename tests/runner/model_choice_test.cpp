/// --model auto: what it chooses, and what happens to a run that exceeds its bound.
#include "experiments/run/model/model_choice.hpp"
#include "experiments/run/state/oracle_state.hpp"
#include "experiments/run/timed/run.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "tests/fixtures/own_directory.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace dss {
namespace {

std::string ladder_scene(const char* name) {
  return std::string(DSS_SOURCE_DIR "/experiments/scenes/ladder/") + name;
}

ModelChoice choice_for(const std::string& scene, double tolerance,
                       const std::string& why_no_watch = {}) {
  return choose_model(load_scene(scene).problem, tolerance, why_no_watch);
}

TEST(ModelChoice, IsTheSmallestModelThatIsProven) {
  EXPECT_EQ(choice_for("chain", 1e-9).chosen, Model::axial);
  const ModelChoice plate = choose_model(load_scene("plate_paper", {{"n", "8"}}).problem, 1e-9);
  EXPECT_EQ(plate.chosen, Model::planar);
  EXPECT_FALSE(plate.is_bounded);
  ASSERT_EQ(plate.smaller.size(), 3u); // axial, bending and membrane, each with its reason
  for (const auto& [model, reason] : plate.smaller) EXPECT_NE(reason, "") << name(model);
  EXPECT_EQ(choice_for("block", 1e-9).chosen, Model::spatial);
  EXPECT_EQ(choice_for(DSS_SOURCE_DIR "/experiments/scenes/failures/free_flight.json", 1e-9).chosen,
            Model::linear);
}

TEST(ModelChoice, TakesSmallRotationsOnTrialOnlyWhereABoundCanBeMetAndWatched) {
  const std::string strip = ladder_scene("strip.json");
  const ModelChoice watched = choice_for(strip, 1e-3);
  EXPECT_EQ(watched.chosen, Model::bending);
  EXPECT_TRUE(watched.is_bounded);
  const ModelChoice exact = choice_for(strip, 1e-9),
                    unwatched = choice_for(strip, 1e-3, "its steps are adaptive");
  EXPECT_EQ(exact.chosen, Model::spatial);
  EXPECT_NE(exact.smaller.back().second.find("only proof helps"), std::string::npos)
      << exact.smaller.back().second;
  EXPECT_EQ(unwatched.chosen, Model::spatial);
  EXPECT_NE(unwatched.smaller.back().second.find("its steps are adaptive"), std::string::npos);
  EXPECT_EQ(choice_for(ladder_scene("eccentric.json"), 1e-2).chosen, Model::linear);
  EXPECT_EQ(choice_for(DSS_SOURCE_DIR "/experiments/scenes/failures/rigid_turn.json", 1e-2).chosen,
            Model::spatial);
}

/// Runs of the variant reference, checked against the spatial oracle in long double.
class AutoRun : public test::OwnDirectory {
protected:
  AutoRun() {
    request.variant = "reference";
    request.is_model_auto = true;
    request.check_tail = 0;
  }
  RunResult run(const std::string& scene, const std::vector<Override>& set, long steps) {
    request.scene = scene;
    request.overrides = set;
    request.steps = steps;
    const Problem problem = load_scene(scene, set).problem;
    write_oracle_state(file("truth"),
                       compute_oracle_state(problem, *find_method("rk4"), Rotation::quaternion,
                                            problem.dt, steps, "truth"));
    request.check_state = file("truth");
    return run_scene(request);
  }
  RunRequest request;
};

TEST_F(AutoRun, IsThePlanarModelOnThePapersPlateAndAgreesWithTheSpatialOneToRounding) {
  const RunResult result = run("plate_paper", {{"n", "10"}}, 500);
  EXPECT_EQ(result.model, "planar");
  EXPECT_EQ(result.model_choice.asked, "auto");
  EXPECT_LE(result.check.error, 1e-12);
}

TEST_F(AutoRun, StaysWithSmallRotationsWhereTheBoundHolds) {
  const RunResult result = run(ladder_scene("strip.json"), {{"n", "8"}, {"width", "3"}}, 1000);
  EXPECT_EQ(result.model, "bending");
  EXPECT_TRUE(result.model_report.promotions.empty());
  EXPECT_GE(result.model_report.looks, 12); // of a short run
  EXPECT_LE(result.check.error, 2 * result.model_report.estimate);
  EXPECT_GT(result.check.error, 1e-9) << "exact after all: the scene shows nothing";
}

TEST_F(AutoRun, IsPromotedWhenAScenesLoadDrivesItOverTheBoundWhileItRunsAndMeetsTheTolerance) {
  const RunResult result = run(ladder_scene("roll_up.json"), {{"n", "8"}}, 2500);
  EXPECT_EQ(result.status, "ok") << result.reason;
  EXPECT_EQ(result.model, "spatial");
  ASSERT_FALSE(result.model_report.promotions.empty());
  const Promotion& first = result.model_report.promotions.front();
  EXPECT_EQ(first.from, Model::bending);
  EXPECT_GT(first.step, 1000); // the load jumps at half of the run
  EXPECT_GT(first.resumed_step, 1000);
  EXPECT_LE(first.resumed_step, first.step);
  EXPECT_LE(result.check.error, 1e-3);
  request.model = "bending"; // bending alone is far off
  const RunResult alone = run(ladder_scene("roll_up.json"), {{"n", "8"}}, 2500);
  EXPECT_EQ(alone.status, "wrong");
  EXPECT_GT(alone.check.error, 0.1);
}

TEST_F(AutoRun, TakesTheModelThatHasProductsWhereForcesTurnWithLinks) {
  const RunResult result = run(ladder_scene("buckling.json"), {}, 1500);
  EXPECT_EQ(result.model_choice.chosen, Model::linear);
  EXPECT_EQ(result.model, "small");
  EXPECT_LE(result.check.error, 1e-2);
}

TEST_F(AutoRun, StopsInsteadIfAskedToAndLeavesNoFiles) {
  request.on_bound = "stop";
  request.output = file("frames.vtu");
  request.frames = 50;
  const RunResult result = run(ladder_scene("roll_up.json"), {{"n", "8"}}, 2500);
  EXPECT_EQ(result.status, "bound");
  EXPECT_NE(result.reason.find("the error of model bending may be"), std::string::npos)
      << result.reason;
  EXPECT_LT(result.steps, 2500);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    files += entry.path().extension() == ".vtu";
  EXPECT_EQ(files, 0u);
}

TEST_F(AutoRun, GivesTheSameFramesAndChecksWhetherPromotedOrNot) {
  request.output = file("frames.vtu");
  request.frames = 10;
  const RunResult result = run(ladder_scene("roll_up.json"), {{"n", "6"}}, 2000);
  EXPECT_FALSE(result.model_report.promotions.empty());
  ASSERT_EQ(result.files.size(), 1u);
  EXPECT_NE(result.files[0].find("lists 11 files"), std::string::npos) << result.files[0];
}

TEST_F(AutoRun, BeginsAnewIfTheEndIsSmallAgainstWhatWentBefore) {
  std::ifstream stream(ladder_scene("strip.json"));
  nlohmann::json scene = nlohmann::json::parse(stream);
  scene["loads"][0]["signal"] = {
      {"table", {{0, 0}, {0.02, 1}, {0.04, 0}}}}; // a pulse, after which all motion dies away
  scene["stabilization"] = {{"d", 3}};
  std::ofstream(file("pulse.json")) << scene;
  const std::vector<Override> set = {{"n", "4"}, {"width", "1"}, {"force", "1e-3"}};
  request.model_tolerance = 1e-4;
  const RunResult result = run(file("pulse.json"), set, 1500);
  ASSERT_EQ(result.model_report.promotions.size(), 1u);
  EXPECT_EQ(result.model_report.promotions[0].step, 1500);
  EXPECT_EQ(result.model_report.promotions[0].resumed_step, 0);
  EXPECT_EQ(result.model, "spatial");
  EXPECT_LE(result.check.error, 1e-11);
}

TEST_F(AutoRun, LooksWhereASignalChangesItsCourseHoweverLongAllWasStill) {
  std::ifstream stream(ladder_scene("strip.json"));
  nlohmann::json scene = nlohmann::json::parse(stream);
  scene["loads"][0]["signal"] = {{"table", {{0, 0}, {0.2, 0}, {0.201, 1}, {0.203, 1}, {0.204, 0}}}};
  std::ofstream(file("late.json")) << scene;
  const RunResult result =
      run(file("late.json"), {{"n", "4"}, {"width", "1"}, {"force", "100"}}, 2000);
  ASSERT_FALSE(result.model_report.promotions.empty());
  EXPECT_GT(result.model_report.promotions[0].step, 1000); // 0.2 s
  EXPECT_LE(result.model_report.promotions[0].step, 1016) << "looks were 160 steps apart before";
}

TEST_F(AutoRun, OfAnotherRotationOrOnRanksOrAdaptiveTakesWhatIsProven) {
  request.rotation = "tait_bryan";
  EXPECT_EQ(run(ladder_scene("strip.json"), {{"n", "4"}}, 20).model, "spatial");
  request.rotation = {};
  request.integrator = "dopri5";
  request.rtol = 1e-6;
  const RunResult adaptive = run(ladder_scene("strip.json"), {{"n", "4"}}, 20);
  EXPECT_EQ(adaptive.model, "spatial");
  EXPECT_NE(adaptive.model_choice.smaller.back().second.find("adaptive"), std::string::npos);
}

TEST_F(AutoRun, StudiesTakeTheScenesModelAndNoOther) {
  request.is_model_auto = false;
  EXPECT_EQ(run("plate_paper", {{"n", "6"}}, 20).model, "spatial");
  EXPECT_EQ(run("plate_paper", {{"n", "6"}, {"run.model", "planar"}}, 20).model, "planar");
  EXPECT_EQ(run("plate_paper", {{"n", "6"}, {"run.model", "auto"}}, 20).model, "spatial");
  request.is_model_auto = true;
  EXPECT_EQ(run("plate_paper", {{"n", "6"}, {"run.model", "linear"}}, 20).model, "linear");
  EXPECT_THROW(run("plate_paper", {{"n", "6"}, {"run.model", "bending"}}, 20), InputError);
}

} // namespace
} // namespace dss
