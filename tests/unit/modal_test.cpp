#include "solver/error.hpp"
#include "solver/numerics/dense_eigen.hpp"
#include "solver/numerics/spectrum.hpp"
#include "solver/statics/equilibrium.hpp"
#include "solver/statics/modal.hpp"
#include "tests/fixtures/problems.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>

namespace dss {
namespace {

Eigen::MatrixXd whole(const SparseMatrix& lower) {
  return SparseMatrix(lower.selfadjointView<Eigen::Lower>());
}

Eigen::VectorXd all_values(const SparseMatrix& stiffness, const SparseMatrix& mass) {
  // K x = omega^2 M x with M = L L^T has the eigenvalues of L^-1 K L^-T.
  const Eigen::LLT<Eigen::MatrixXd> cholesky(whole(mass));
  const Eigen::MatrixXd half = cholesky.matrixL().solve(whole(stiffness));
  return SymmetricEigen(cholesky.matrixL().solve(half.transpose())).values;
}

Problem held_block(LinkLaw law) {
  Problem problem = fixture::make_block(3, 2, 2, law);
  for (std::size_t e = 0; e < problem.lattice.element_count; e += 3)
    problem.clamps.push_back({e, dof_all});
  return problem;
}

TEST(Modal, values_are_those_of_the_dense_problem) {
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material}) {
    const Problem problem = held_block(law);
    const StaticSystem system(problem);
    const SparseMatrix stiffness = system.stiffness_at_rest(), mass = system.mass(system.rest());
    const Eigen::VectorXd all = all_values(stiffness, mass);
    EXPECT_NEAR(std::sqrt(all.maxCoeff()), krylov_spectrum(problem).omega_max,
                1e-3 * std::sqrt(all.maxCoeff()));
    for (const int count : {1, 7, int(all.size())}) {
      const Eigenmodes few = lowest_modes(stiffness, mass, count);
      for (int n = 0; n < count; ++n) EXPECT_NEAR(few.values[n], all[n], 1e-9 * all[n]) << n;
      const Eigen::MatrixXd product = few.shapes.transpose() * whole(mass) * few.shapes;
      EXPECT_LT((product - Eigen::MatrixXd::Identity(count, count)).norm(), 1e-8);
    }
  }
}

TEST(Modal, equal_values_are_all_found) {
  SparseMatrix stiffness(60, 60), mass(60, 60);
  for (int n = 0; n < 60; ++n)
    stiffness.insert(n, n) = n < 13 ? 2.0 : double(n), mass.insert(n, n) = 1;
  const Eigenmodes found = lowest_modes(stiffness, mass, 14);
  for (int n = 0; n < 13; ++n) EXPECT_NEAR(found.values[n], 2, 1e-9);
  EXPECT_NEAR(found.values[13], 13, 1e-8);
}

TEST(Modal, values_on_both_sides_of_zero_are_found_from_a_shift_below) {
  SparseMatrix stiffness(40, 40), mass(40, 40);
  for (int n = 0; n < 40; ++n) stiffness.insert(n, n) = double(n) - 1.5, mass.insert(n, n) = 1;
  const Eigen::VectorXd values = lowest_modes(stiffness, mass, 3, -4).values;
  EXPECT_NEAR(values[0], -1.5, 1e-8);
  EXPECT_NEAR(values[1], -0.5, 1e-8);
  EXPECT_NEAR(values[2], 0.5, 1e-8);
  EXPECT_THROW(lowest_modes(stiffness, mass, 3, -1), InputError); // one mode is below
}

TEST(Modal, row_of_elements_has_the_frequencies_of_masses_and_springs) {
  constexpr int n = 10; // the first is held: 9 free masses
  Problem problem = fixture::make_block(n, 1, 1, LinkLaw::material);
  problem.clamps = {{0, dof_all}};
  const StaticSystem system(problem, Rotation::linearised, dof_ux);
  const ModalAnalysis found = find_modes(system, 9, system.rest(), true);
  const Body& body = problem.bodies.front();
  double mass = 0;
  for (int p = 1; p <= 9; ++p) {
    const NaturalMode& mode = found.modes[std::size_t(p - 1)];
    const double omega = 2 * std::sqrt(body.axis[0].k_normal / body.mass) *
                         std::sin((2 * p - 1) * M_PI / (2 * (2 * 9 + 1)));
    EXPECT_NEAR(mode.omega, omega, 1e-9 * omega);
    mass += mode.effective_mass[0];
  }
  EXPECT_EQ(found.modes[0].element, 9u); // most of the first mode's energy is at the free end
  EXPECT_NEAR(mass, 9 * body.mass, 1e-9);
  EXPECT_NEAR(found.free_mass[0], 9 * body.mass, 1e-9);
}

TEST(Modal, effective_masses_of_all_modes_are_the_mass_that_may_move) {
  const Problem problem = held_block(LinkLaw::material);
  const StaticSystem system(problem);
  const ModalAnalysis found = find_modes(system, int(system.size()), system.rest(), true);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (const NaturalMode& mode : found.modes) sum += mode.effective_mass[axis];
    EXPECT_NEAR(sum, found.free_mass[axis], 1e-8);
  }
}

TEST(Modal, rigid_motions_of_a_free_body_are_counted) {
  const Problem problem = fixture::make_block(3, 2, 2, LinkLaw::material);
  const StaticSystem system(problem);
  const ModalAnalysis found = find_modes(system, 5, system.rest(), true);
  EXPECT_EQ(found.free_motions, 6);
  const Eigen::VectorXd all = all_values(system.stiffness_at_rest(), system.mass(system.rest()));
  ASSERT_EQ(found.modes.size(), 5u);
  for (int n = 0; n < 5; ++n)
    EXPECT_NEAR(found.modes[std::size_t(n)].omega, std::sqrt(all[6 + n]),
                1e-7 * std::sqrt(all[6 + n]));
}

TEST(Modal, too_many_mechanisms_are_refused) {
  const Problem plate =
      fixture::make_plate(10); // links without rotational springs: free to leave the plane
  const StaticSystem spatial(plate), planar(plate, Rotation::quaternion, degrees_of(Model::planar));
  EXPECT_THROW(find_modes(spatial, 3, spatial.rest(), true), InputError);
  EXPECT_EQ(find_modes(planar, 3, planar.rest(), true).free_motions, 0);
}

TEST(Modal, tension_raises_the_frequency_of_a_row) {
  Problem problem = fixture::make_block(8, 1, 1, LinkLaw::material);
  problem.clamps = {{0, dof_all}};
  const auto lowest = [&](double force) {
    problem.loads = {{{7}, {force, 0, 0}, {}, {}}};
    StaticSystem system(problem);
    return find_modes(system, 1, find_equilibrium(system).state, false).modes.front().omega;
  };
  EXPECT_LT(lowest(-5), lowest(0));
  EXPECT_GT(lowest(5), lowest(0));
}

} // namespace
} // namespace dss
