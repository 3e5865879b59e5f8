#include "solver/error.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/scene/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace dss {
namespace {

std::size_t index_of(const Problem& problem, int x, int y, int nx) {
  EXPECT_EQ(problem.lattice.rows.size() * std::size_t(nx), problem.lattice.element_count);
  return std::size_t(y) * std::size_t(nx) + std::size_t(x);
}

TEST(shipped_scenes, are_all_listed_under_their_file_names) {
  std::vector<std::string> names;
  for (const SceneListing& scene : list_scenes()) {
    names.push_back(scene.name);
    EXPECT_EQ(std::filesystem::path(scene.path).stem().string(), scene.name);
    EXPECT_FALSE(scene.title.empty());
  }
  for (const char* name : {"plate_paper", "plate_bending", "cantilever_beam", "block",
                           "two_elements", "chain", "tumbling_box", "l_bracket", "two_bodies"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

TEST(shipped_scenes, have_small_versions_whose_step_is_at_most_half_the_limit_of_rk4) {
  for (const SceneListing& listing : list_scenes()) {
    const Scene scene = load_scene(listing.name);
    ASSERT_FALSE(scene.verify.empty());
    for (const VerifyCase& verify : scene.verify) {
      const Scene small = load_scene(listing.name, verify_overrides(verify));
      EXPECT_LE(small.problem.lattice.element_count, 300U) << listing.name;
      EXPECT_EQ(small.problem.steps, verify.steps);
      EXPECT_LE(small.problem.steps, 200) << listing.name;
      const Method& rk4 = *find_method(
          "rk4"); // the exact limit takes seconds; it is computed only if the bound is too low
      if (small.problem.dt > 0.5 * stable_step(small.problem, rk4).dt) {
        EXPECT_LE(small.problem.dt, 0.5 * stable_step(small.problem, rk4, true).dt) << listing.name;
      }
      EXPECT_LE(small.problem.tolerance_f64.run, 1e-9) << listing.name;
      EXPECT_LE(small.problem.tolerance_f64.evaluation, 1e-13) << listing.name;
      EXPECT_LE(small.problem.tolerance_f32.evaluation, 1e-5) << listing.name;
    }
  }
}

TEST(shipped_scenes, have_a_stable_step_for_rk4_at_full_size) {
  for (const SceneListing& listing : list_scenes()) {
    const Scene scene = load_scene(listing.name);
    EXPECT_LE(scene.problem.dt, stable_step(scene.problem, *find_method("rk4")).dt) << listing.name;
  }
}

TEST(plate_paper, is_the_published_benchmark) {
  for (const int n : {100, 50, 7, 3, 1}) {
    const Problem problem = load_scene("plate_paper", {{"n", std::to_string(n)}}).problem;
    ASSERT_EQ(problem.lattice.element_count, std::size_t(n) * std::size_t(n));
    EXPECT_EQ(problem.dt, 1e-6);
    for (const double edge : problem.bodies.at(0).edge) EXPECT_EQ(edge, 0.8 / n);
    ASSERT_EQ(problem.clamps.size(), std::size_t(n));
    for (std::size_t k = 0; k < std::size_t(n); ++k) {
      EXPECT_EQ(problem.clamps[k].element, k);
      EXPECT_EQ(problem.clamps[k].dofs, dof_all);
    }
    const int loaded = std::max(1, n / 4);
    const Load& load = problem.loads.at(0);
    ASSERT_EQ(load.elements.size(), std::size_t(loaded));
    for (int k = 0; k < loaded; ++k)
      EXPECT_EQ(load.elements[std::size_t(k)], index_of(problem, n - 1, n - loaded + k, n));
    EXPECT_EQ(load.force, (Vec3{1000.0 / loaded, 0, 0}));
    EXPECT_EQ(load.signal(0), 1);
    EXPECT_EQ(load.signal(5), 1);
  }
}

TEST(two_bodies, are_joined_face_to_face_in_order) {
  const Problem problem = load_scene("two_bodies").problem;
  ASSERT_EQ(problem.bodies.size(), 2U);
  const std::size_t post = 4 * 9 * 2;
  ASSERT_EQ(problem.extra_links.size(), 8U);
  for (std::size_t z = 0; z < 2; ++z)
    for (std::size_t x = 0; x < 4; ++x) {
      const ExtraLink& link = problem.extra_links[4 * z + x];
      EXPECT_EQ(link.axis, 1);
      EXPECT_EQ(link.i, z * 36 + 8 * 4 + x);
      EXPECT_EQ(link.j, post + z * 22 + x);
      EXPECT_DOUBLE_EQ(link.constants.k_normal, 5e6 * 0.05 * 0.05 / 0.045);
    }
  // The elements feel gravity minus the acceleration of their frame.
  EXPECT_DOUBLE_EQ(problem.frame_acceleration[0](0), -5 * std::sin(0.5));
  EXPECT_DOUBLE_EQ(problem.frame_acceleration[1](0.1), -9.81);
  EXPECT_EQ(problem.frame_acceleration[2](0.1), 0);
}

TEST(l_bracket, has_its_hole) {
  const Problem problem = load_scene("l_bracket").problem;
  EXPECT_EQ(problem.lattice.element_count, 2U * (12 * 5 - 4 + 4 * 5));
  const Row& row = problem.lattice.rows.at(2);
  EXPECT_TRUE(problem.lattice.is_present(row, 2));
  EXPECT_FALSE(problem.lattice.is_present(row, 3));
  EXPECT_FALSE(problem.lattice.is_present(row, 4));
  EXPECT_TRUE(problem.lattice.is_present(row, 5));
}

} // namespace
} // namespace dss
