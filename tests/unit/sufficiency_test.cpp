#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/reference/oracle.hpp"
#include "solver/scene/scene.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

namespace dss {
namespace {

void expect_reason(const std::string& reason, const std::string& part) {
  EXPECT_NE(reason.find(part), std::string::npos) << "reason: \"" << reason << "\"";
  EXPECT_EQ(reason.find('\n'), std::string::npos);
}

/// nx x ny x 1 elements with soft links. Those at x = 0 are clamped, all others are pulled along x.
Problem pulled_plate(int nx, int ny) {
  Problem problem = fixture::make_block(nx, ny, 1, LinkLaw::material);
  problem.loads.resize(1);
  for (int y = 0; y < ny; ++y) {
    problem.clamps.push_back({std::size_t(y * nx), dof_all});
    problem.loads[0].elements.push_back(std::size_t(y * nx + nx - 1));
  }
  problem.loads[0].force = {5, 0, 0};
  return problem;
}

/// Largest field that is not along x after a run of the spatial model.
double off_axis(const Problem& problem) {
  Oracle<double> oracle(problem, *find_method("rk4"), problem.dt);
  const std::vector<double> start = initial_state(problem);
  oracle.write(start);
  EXPECT_FALSE(oracle.advance(200));
  std::vector<double> state(start.size());
  oracle.read(state);
  double most = 0;
  for (std::size_t n = 0; n < state.size(); ++n)
    if (n % field_count != ux && n % field_count != vx) most = std::max(most, std::abs(state[n]));
  return most;
}

TEST(why_not_axial,
     is_empty_for_a_bar_and_for_rows_that_move_alike_and_these_stay_on_their_axis_to_the_last_bit) {
  for (const Problem& problem : {pulled_plate(5, 1), pulled_plate(5, 4)}) {
    EXPECT_EQ(why_not_axial(problem), "");
    EXPECT_EQ(off_axis(problem), 0);
  }
  for (const char* name : {"chain", "two_elements"})
    EXPECT_EQ(why_not_axial(load_scene(name).problem), "");
}

TEST(why_not_axial, names_rows_that_differ_by_a_load_a_clamp_a_start_or_their_length) {
  Problem loaded = pulled_plate(5, 4), clamped = loaded, started = loaded;
  loaded.loads[0].elements.pop_back();
  clamped.clamps.pop_back();
  started.initial_motions.resize(1);
  started.initial_motions[0].elements = {7};
  started.initial_motions[0].velocity = {0.1, 0, 0};
  for (const Problem& problem : {loaded, clamped, started}) {
    expect_reason(why_not_axial(problem), "need not move alike");
    EXPECT_GT(off_axis(problem), 0);
  }
  expect_reason(why_not_axial(load_scene("plate_paper", {{"n", "8"}}).problem),
                "(0, 0) and (1, 0)");
  Problem ragged = fixture::make_sponge(5, 4, 1, LinkLaw::material, 1);
  ragged.frame_acceleration[0].amplitude = 1;
  expect_reason(why_not_axial(ragged), "need not move alike");
}

TEST(why_not_axial, knows_clamps_of_what_does_not_move_and_loads_that_never_act) {
  Problem problem = pulled_plate(5, 4);
  problem.clamps.push_back({19, dof_ry | dof_uz});
  problem.loads.push_back({{3}, {1, 2, 3}, {4, 5, 6}, {}});
  problem.loads[1].signal.amplitude = 0;
  EXPECT_EQ(why_not_axial(problem), "");
  EXPECT_EQ(off_axis(problem), 0);
}

TEST(why_not_axial, names_what_leaves_the_axis) {
  const Problem plain = pulled_plate(5, 1);
  Problem problem = plain;
  problem.loads[0].force[1] = 2;
  expect_reason(why_not_axial(problem), "load 0 has force y = 2 N");
  problem = plain;
  problem.loads[0].torque[0] = 3;
  expect_reason(why_not_axial(problem), "load 0 has torque x = 3 N m");
  problem = plain;
  problem.frame_acceleration[2].amplitude = 1;
  expect_reason(why_not_axial(problem), "along z");
  problem = plain;
  problem.initial_motions.resize(1);
  problem.initial_motions[0].elements = {3};
  problem.initial_motions[0].angular_velocity = {1, 0, 0};
  expect_reason(why_not_axial(problem), "element 3 starts with wx = 1 rad/s");
}

/// Behind each row of the first body stands a second bar of one row, joined along x.
Problem joined(int rows, std::size_t most_joints) {
  Problem problem = pulled_plate(4, rows);
  problem.loads.clear();
  const std::size_t first = problem.lattice.element_count;
  fixture::add_block(problem, fixture::soft_body(LinkLaw::material), 3, rows, 1);
  Load load;
  for (std::size_t y = 0; y < std::size_t(rows); ++y) load.elements.push_back(first + 3 * y + 2);
  load.force = {4, 0, 0};
  problem.loads = {load};
  for (std::size_t y = 0; y < std::min(most_joints, std::size_t(rows)); ++y)
    problem.extra_links.push_back({4 * y + 3, first + 3 * y, 0, LinkLaw::material,
                                   fixture::soft_body(LinkLaw::material).axis[0]});
  return problem;
}

TEST(why_not_axial, follows_rows_through_links_outside_the_grid) {
  const Problem alike = joined(3, 3), one_open = joined(3, 2);
  EXPECT_EQ(why_not_axial(alike), "");
  EXPECT_EQ(off_axis(alike), 0);
  expect_reason(why_not_axial(one_open), "need not move alike");
  EXPECT_GT(off_axis(one_open), 0);
  Problem other_constants = alike;
  other_constants.extra_links[1].constants.k_normal *= 2;
  expect_reason(why_not_axial(other_constants), "need not move alike");
  EXPECT_GT(off_axis(other_constants), 0);
  Problem across = alike;
  across.extra_links[1].axis = 1;
  expect_reason(why_not_axial(across), "extra link 1 between elements 7 and 15 is along y");
}

TEST(why_not_bending, is_empty_for_a_plate_loaded_out_of_its_plane_and_names_what_acts_within) {
  EXPECT_EQ(why_not_bending(load_scene("plate_bending", {{"n", "8"}}).problem), "");
  EXPECT_EQ(why_not_bending(load_scene("cantilever_beam").problem), "");
  Problem problem = fixture::make_plate(8);
  expect_reason(why_not_bending(problem), "load 0 has force x = 500 N");
  problem.loads[0].force = {0, 0, 1};
  problem.loads[0].torque = {1, 1, 0};
  EXPECT_EQ(why_not_bending(problem), "");
  problem.loads[0].torque[2] = 1;
  expect_reason(why_not_bending(problem), "torque z = 1 N m");
  problem.loads.clear();
  problem.frame_acceleration[1].amplitude = 2;
  expect_reason(why_not_bending(problem), "along y");
  problem.frame_acceleration[1].amplitude = 0;
  problem.extra_links.push_back({1, 9, 2, LinkLaw::paper, {}});
  expect_reason(why_not_bending(problem), "extra link 0 between elements 1 and 9 is along z");
  expect_reason(why_not_bending(load_scene("block").problem), "more than one element thick in z");
}

TEST(why_not_bending, looks_at_the_start_itself_a_plate_turned_as_one_body_leaves_by_the_cosine) {
  Problem problem = fixture::make_plate(4);
  problem.loads.clear();
  problem.clamps.clear();
  problem.initial_motions.resize(1);
  for (std::size_t e = 0; e < 16; ++e) problem.initial_motions[0].elements.push_back(e);
  problem.initial_motions[0].rotation = {0.1, 0, 0};
  EXPECT_EQ(why_not_bending(problem), "");
  problem.initial_motions[0].is_rigid = true;
  expect_reason(why_not_bending(problem), "starts with uy");
}

TEST(why_not_in_translation, is_empty_where_all_elements_fly_alike) {
  Problem problem = fixture::make_tumbling_box();
  problem.initial_motions[0].angular_velocity = {};
  problem.frame_acceleration[2].amplitude = -9.81;
  EXPECT_EQ(why_not_in_translation(problem), "");
  EXPECT_EQ(why_not_exact(Model::linear, problem), "");
  Load load{problem.initial_motions[0].elements, {1, 2, 3}, {}, {}};
  problem.loads = {load};
  EXPECT_EQ(why_not_in_translation(problem), "");
  problem.loads[0].elements.pop_back();
  expect_reason(why_not_in_translation(problem), "load 0 pulls some elements");
  problem.loads = {load};
  problem.initial_motions[0].elements.pop_back();
  expect_reason(why_not_in_translation(problem), "starts otherwise");
  problem.clamps = {{2, dof_uz}};
  expect_reason(why_not_in_translation(problem), "element 2 is clamped");
  expect_reason(why_not_in_translation(fixture::make_tumbling_box()), "starts with");
}

TEST(smallest_exact, is_of_small_rotations_where_nothing_turns) {
  Problem problem = fixture::make_block(5, 4, 1, LinkLaw::paper);
  problem.clamps.clear();
  problem.loads.clear();
  problem.frame_acceleration[0].amplitude = 2;
  problem.frame_acceleration[1].amplitude = 1;
  EXPECT_EQ(smallest_exact(problem), Model::membrane);
  problem.frame_acceleration[0].amplitude = problem.frame_acceleration[1].amplitude = 0;
  problem.frame_acceleration[2].amplitude = -9.81;
  EXPECT_EQ(smallest_exact(problem), Model::bending);
  problem.frame_acceleration[0].amplitude = 2;
  EXPECT_EQ(smallest_exact(problem), Model::linear);
  EXPECT_EQ(smallest_exact(load_scene("plate_paper", {{"n", "8"}}).problem), Model::planar);
  EXPECT_EQ(smallest_exact(load_scene("block").problem), Model::spatial);
}

TEST(why_not_exact, leaves_small_rotations_to_the_bound) {
  const Problem beam = load_scene("cantilever_beam").problem;
  EXPECT_EQ(why_not(Model::bending, beam), "");
  for (const Model model : {Model::bending, Model::linear, Model::small})
    expect_reason(why_not_exact(model, beam), "small rotations are assumed");
  const Problem plate = load_scene("plate_paper", {{"n", "8"}}).problem;
  EXPECT_EQ(why_not(Model::membrane, plate), "");
  expect_reason(why_not_exact(Model::membrane, plate), "small rotations are assumed");
  expect_reason(why_not(Model::membrane, beam), "load 0 leaves the plane");
  EXPECT_EQ(why_not_exact(Model::spatial, beam), "");
  expect_reason(why_not_exact(Model::planar, beam), "load 0 leaves the plane");
}

} // namespace
} // namespace dss
