#include "solver/decomposition/part.hpp"
#include "tests/fixtures/decompositions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

namespace dss {
namespace {

using fixture::global_numbers;

/// For local numbers of a part: the numbers in the whole.
std::vector<std::size_t> mapped(const std::vector<std::size_t>& local,
                                const std::vector<std::size_t>& global) {
  std::vector<std::size_t> numbers;
  for (const std::size_t e : local) numbers.push_back(global.at(e));
  return numbers;
}

std::vector<std::size_t> kept(const std::vector<std::size_t>& elements,
                              const std::vector<std::size_t>& global) {
  std::vector<std::size_t> numbers;
  for (const std::size_t e : elements)
    if (std::binary_search(global.begin(), global.end(), e)) numbers.push_back(e);
  return numbers;
}

TEST(part, has_the_terms_on_its_elements_and_all_else_as_the_whole) {
  Problem problem = fixture::make_everything();
  InitialMotion motion;
  motion.elements = {30, 2, 7, 1}; // not sorted
  motion.velocity = {1, 2, 3};
  motion.centre = {0.1, 0.2, 0.3};
  motion.is_rigid = true;
  problem.initial_motions = {motion, motion};
  problem.initial_motions[1].elements = {5};
  for (const Decomposition& decomposition : fixture::decompositions_of(problem))
    for (int index = 0; index < decomposition.parts; ++index) {
      const Part part = make_part(problem, decomposition, index, 1);
      const Problem& here = part.problem;
      const std::vector<std::size_t> global = global_numbers(problem, part);
      std::vector<std::size_t> clamped, clamped_here;
      for (const Clamp& clamp : problem.clamps) clamped.push_back(clamp.element);
      for (const Clamp& clamp : here.clamps) clamped_here.push_back(clamp.element);
      EXPECT_EQ(mapped(clamped_here, global), kept(clamped, global));
      ASSERT_EQ(here.loads.size(), problem.loads.size());
      for (std::size_t l = 0; l < here.loads.size(); ++l) {
        EXPECT_EQ(mapped(here.loads[l].elements, global), kept(problem.loads[l].elements, global));
        EXPECT_EQ(here.loads[l].force, problem.loads[l].force);
        EXPECT_EQ(here.loads[l].torque, problem.loads[l].torque);
        EXPECT_EQ(here.loads[l].signal.kind, problem.loads[l].signal.kind);
      }
      ASSERT_EQ(here.initial_motions.size(), 2U);
      for (std::size_t m = 0; m < 2; ++m) {
        EXPECT_EQ(mapped(here.initial_motions[m].elements, global),
                  kept(problem.initial_motions[m].elements, global));
        EXPECT_EQ(here.initial_motions[m].velocity, motion.velocity);
        EXPECT_EQ(here.initial_motions[m].centre, motion.centre);
        EXPECT_TRUE(here.initial_motions[m].is_rigid);
      }
      EXPECT_EQ(here.bodies.size(), problem.bodies.size());
      EXPECT_EQ(here.name, problem.name);
      EXPECT_EQ(here.dt, problem.dt);
      EXPECT_EQ(here.steps, problem.steps);
      EXPECT_EQ(here.integrator, problem.integrator);
      EXPECT_EQ(here.stabilization.k_rot, problem.stabilization.k_rot);
      EXPECT_EQ(here.frame_acceleration[2].amplitude, -9.81);
      EXPECT_EQ(here.tolerance_f64.run, problem.tolerance_f64.run);
    }
}

TEST(part, knows_of_damped_links_that_are_elsewhere) {
  Problem problem = fixture::make_damped_joint();
  const Decomposition decomposition = decompose(problem, "strips", 4);
  for (int index = 0; index < 4; ++index)
    EXPECT_TRUE(make_part(problem, decomposition, index, 0).problem.has_damped_links_elsewhere);
  for (ExtraLink& link : problem.extra_links)
    link.constants = fixture::soft_body(LinkLaw::paper, 0).axis[0];
  for (int index = 0; index < 4; ++index)
    EXPECT_FALSE(make_part(problem, decomposition, index, 0).problem.has_damped_links_elsewhere);
}

TEST(part, the_only_part_is_the_problem) {
  for (const Problem& problem : fixture::divisible_problems()) {
    const Part part = make_part(problem, decompose(problem, "blocks", 1), 0, 4);
    EXPECT_EQ(part.own_elements, problem.lattice.element_count);
    EXPECT_EQ(part.problem.lattice.present, problem.lattice.present);
    ASSERT_EQ(part.runs.size(), 1U);
    EXPECT_EQ(part.runs[0].count, problem.lattice.element_count);
    EXPECT_TRUE(part.neighbours.empty());
    for (std::size_t r = 0; r < problem.lattice.rows.size(); ++r) {
      const Row &here = part.problem.lattice.rows[r], &there = problem.lattice.rows[r];
      EXPECT_EQ(std::tie(here.x_begin, here.x_end, here.first_element, here.first_cell),
                std::tie(there.x_begin, there.x_end, there.first_element, there.first_cell));
      EXPECT_EQ(std::tie(here.lower_y, here.upper_y, here.lower_z, here.upper_z),
                std::tie(there.lower_y, there.upper_y, there.lower_z, there.upper_z));
    }
  }
}

} // namespace
} // namespace dss
