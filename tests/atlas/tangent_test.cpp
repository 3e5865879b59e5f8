#include "experiments/runner/atlas/beam_theory.hpp"
#include "experiments/runner/atlas/continuum_study.hpp"
#include "experiments/runner/atlas/tangent.hpp"
#include "solver/error.hpp"
#include "solver/numerics/spectrum.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cmath>

namespace dss {
namespace {

/// A block held on one side, pulled at the other.
Problem held_block(LinkLaw law) {
  Problem problem = fixture::make_block(3, 2, 2, law);
  for (std::size_t e = 0; e < problem.lattice.element_count; e += 3) problem.clamps.push_back({e, dof_all});
  problem.loads = {{{2, 5}, {1e-3, -2e-3, 3e-3}, {1e-5, 0, 2e-5}, {}}};
  return problem;
}

std::vector<double> rest(const Problem& problem) {
  return std::vector<double>(problem.lattice.element_count * field_count, 0.0);
}

TEST(Tangent, at_rest_has_the_largest_frequency_that_the_links_matrices_give) {
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material}) {
    const Problem problem = held_block(law);
    const FreeDofs dofs = free_dofs(problem);
    const Eigen::MatrixXd stiffness = tangent_stiffness(problem, dofs, rest(problem));
    const Eigen::VectorXd scale = dofs.inertia.cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd all =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scale.asDiagonal() * stiffness * scale.asDiagonal())
            .eigenvalues();
    EXPECT_NEAR(std::sqrt(all.maxCoeff()), krylov_spectrum(problem).omega_max, 1e-3 * std::sqrt(all.maxCoeff()));
    const Eigen::VectorXd few = smallest_eigenvalues(stiffness.sparseView(), dofs.inertia, 4);
    for (int n = 0; n < 4; ++n) EXPECT_NEAR(few[n], all[n], 1e-8 * all[n]) << n;
  }
}

TEST(Tangent, finds_small_eigenvalues_on_both_sides_of_zero_from_a_shift_below) {
  Eigen::SparseMatrix<double> stiffness(40, 40);
  for (int n = 0; n < 40; ++n) stiffness.insert(n, n) = double(n) - 1.5;
  const Eigen::VectorXd values = smallest_eigenvalues(stiffness, Eigen::VectorXd::Ones(40), 3, -4);
  EXPECT_NEAR(values[0], -1.5, 1e-8);
  EXPECT_NEAR(values[1], -0.5, 1e-8);
  EXPECT_NEAR(values[2], 0.5, 1e-8);
}

TEST(Tangent, finds_an_equilibrium_at_which_no_force_is_left) {
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material}) {
    Problem problem = held_block(law);
    const FreeDofs dofs = free_dofs(problem);
    const std::vector<double> state = equilibrium(problem, dofs, rest(problem));
    EXPECT_GT(std::abs(state[2 * field_count + uz]), 1e-8);
    // From there it does not move, whatever the oracle's own step.
    const std::vector<double> again = equilibrium(problem, dofs, state);
    for (std::size_t n = 0; n < state.size(); ++n) EXPECT_NEAR(again[n], state[n], 1e-14);
  }
}

TEST(Tangent, says_so_where_a_free_body_has_no_equilibrium) {
  Problem problem = held_block(LinkLaw::material);
  problem.clamps.clear();
  EXPECT_THROW(equilibrium(problem, free_dofs(problem), rest(problem)), InputError);
}

TEST(CantileverFrequencies, of_a_slender_beam_are_euler_and_bernoullis) {
  const std::vector<double> found = cantilever_frequencies({1, 1e9, 1, 1e-9, 1}, 3);
  // Squares of the roots of cos x cosh x = -1.
  for (std::size_t n = 0; n < 3; ++n) {
    const double root = std::sqrt(found[n]);
    EXPECT_NEAR(std::cos(root) * std::cosh(root), -1, 1e-4 * std::cosh(root)) << n;
  }
  EXPECT_NEAR(found[0], 3.516015, 1e-5);
}

TEST(CantileverFrequencies, end_at_the_cut_off) {
  EXPECT_THROW(cantilever_frequencies({1, 10, 1, 0.05, 1}, 20), InputError);
}

TEST(Richardson, finds_the_order_and_the_limit_of_a_power) {
  const std::vector<double> spacing = {0.4, 0.17, 0.1};
  std::vector<double> figures;
  for (const double h : spacing) figures.push_back(7 - 3 * std::pow(h, 1.7));
  const Richardson found = richardson(spacing, figures);
  EXPECT_NEAR(found.order, 1.7, 1e-9);
  EXPECT_NEAR(found.limit, 7, 1e-9);
  EXPECT_TRUE(std::isnan(richardson(spacing, {1, 2, 1}).order));
}

} // namespace
} // namespace dss
