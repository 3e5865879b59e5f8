/// Stress and strain against closed forms, by the links of the equations that a state comes from.
#include "solver/model/rotation_vector.hpp"
#include "solver/model/stress/stress_field.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "tests/fixtures/problems.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace dss::test {
namespace {

double largest_von_mises(const Problem& problem, const std::vector<double>& state,
                         Rotation equations) {
  double largest = 0;
  const StressField field(problem, state, equations, {});
  for (const ElementStress& element : field.elements())
    largest = std::max(largest, von_mises(element.stress));
  return largest;
}

/// A block that turned about z as one body, in equations with rotation vectors: u = theta x
/// position, without shortening.
std::vector<double> turned_by_vectors(const Problem& problem, double theta) {
  std::vector<double> state(problem.lattice.element_count * field_count);
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const Vec3 place = rest_position(problem, row, x);
    const auto fields = std::span(state).subspan(e * field_count, field_count);
    fields[ux] = -theta * place[1];
    fields[uy] = theta * place[0];
    fields[qz] = theta / 2;
    to_quaternion(fields);
  });
  return state;
}

TEST(Stress, is_none_in_a_rigid_turn_by_the_equations_that_it_comes_from) {
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material}) {
    const Problem problem = fixture::make_block(4, 3, 2, law, 0);
    const std::vector<double> state = turned_by_vectors(problem, 0.05);
    const double by_spatial = largest_von_mises(problem, state, Rotation::quaternion);
    EXPECT_GT(by_spatial, 0);
    for (const Rotation equations : {Rotation::linearised, Rotation::small})
      EXPECT_LE(largest_von_mises(problem, state, equations), 1e-10 * by_spatial)
          << name(equations);
  }
}

TEST(Stress, is_the_same_by_all_equations_to_first_order) {
  const Problem problem = fixture::make_block(4, 3, 2, LinkLaw::material);
  const std::vector<double> state = fixture::random_state(problem, 5, 1e-7, 1e-6, 1e-6);
  const double by_spatial = largest_von_mises(problem, state, Rotation::quaternion);
  for (const Rotation equations : {Rotation::linearised, Rotation::small})
    EXPECT_NEAR(largest_von_mises(problem, state, equations) / by_spatial, 1, 1e-4)
        << name(equations);
}

} // namespace
} // namespace dss::test
