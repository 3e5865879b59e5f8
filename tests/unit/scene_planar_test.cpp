#include "solver/scene/scene.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

namespace dss {
namespace {

void expect_reason(const Problem& problem, const std::string& part) {
  const std::string reason = why_not_planar(problem);
  EXPECT_NE(reason.find(part), std::string::npos) << "reason: \"" << reason << "\"";
  EXPECT_EQ(reason.find('\n'), std::string::npos);
}

TEST(why_not_planar, is_empty_for_scenes_that_stay_in_the_plane) {
  for (const char* name : {"plate_paper", "two_elements", "chain"})
    EXPECT_EQ(why_not_planar(load_scene(name).problem), "");
}

TEST(why_not_planar, names_the_load_that_leaves_the_plane) {
  expect_reason(load_scene("plate_bending", {{"n", "8"}}).problem,
                "load 0 leaves the plane: force z = 500 N");
  Problem problem = fixture::make_plate(8);
  problem.loads[0].torque = {0, 0.5, 0};
  expect_reason(problem, "torque y = 0.5 N m");
  problem.loads[0].signal.amplitude = 0; // never acts
  EXPECT_EQ(why_not_planar(problem), "");
}

TEST(why_not_planar, names_the_body_that_is_thick) {
  expect_reason(load_scene("block").problem, "body \"block\" is more than one element thick in z");
}

TEST(why_not_planar, names_links_gravity_and_motions_out_of_the_plane) {
  Problem problem = fixture::make_plate(8);
  problem.frame_acceleration[2].offset = 1e-3;
  expect_reason(problem, "along z");
  problem = fixture::make_plate(8);
  problem.extra_links.push_back({1, 9, 2, LinkLaw::paper, {}});
  expect_reason(problem, "extra link 0");
  for (const auto& [field, part] : std::vector<std::pair<Vec3 InitialMotion::*, std::string>>{
           {&InitialMotion::displacement, "displacement z"},
           {&InitialMotion::velocity, "velocity z"}}) {
    problem = fixture::make_plate(8);
    problem.initial_motions.resize(1);
    (problem.initial_motions[0].*field) = {1, 1, 0};
    EXPECT_EQ(why_not_planar(problem), "");
    (problem.initial_motions[0].*field) = {0, 0, 1};
    expect_reason(problem, part);
  }
  for (const auto& [field, part] : std::vector<std::pair<Vec3 InitialMotion::*, std::string>>{
           {&InitialMotion::rotation, "rotation x"},
           {&InitialMotion::angular_velocity, "angular velocity x"}}) {
    problem = fixture::make_plate(8);
    problem.initial_motions.resize(1);
    (problem.initial_motions[0].*field) = {0, 0, 1};
    EXPECT_EQ(why_not_planar(problem), "");
    (problem.initial_motions[0].*field) = {1, 0, 0};
    expect_reason(problem, part);
  }
}

TEST(why_not_planar, is_told_when_a_scene_asks_for_planar_and_leaves_the_plane) {
  EXPECT_EQ(load_scene("plate_paper", {{"run.model", "planar"}, {"n", "8"}}).model, "planar");
  try {
    load_scene("plate_bending", {{"run.model", "planar"}});
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/run/model: \"planar\" does not hold: load 0"),
              std::string::npos)
        << error.what();
  }
}

} // namespace
} // namespace dss
