/// Solids with nu > 0: the pressure of their elements (solver/reference/pressure.hpp).
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/numerics/dense_eigen.hpp"
#include "solver/numerics/linearised.hpp"
#include "solver/numerics/spectrum.hpp"
#include "solver/reference/rotation_vector.hpp"
#include "solver/statics/equilibrium.hpp"
#include "tests/fixtures/solids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dss {
namespace {

using Real = StaticSystem::Real;
using Vec = Eigen::Vector3d;

constexpr double mu = fixture::solid_mu;

Problem contracting_solid(const VoxelGrid& grid, const Vec3& edge, double nu) {
  return fixture::contracting_solid(grid, edge, nu);
}
VoxelGrid whole(int nx, int ny, int nz) { return fixture::whole_grid(nx, ny, nz); }
/// A block without its upper quarter, and without some cells of a corner.
VoxelGrid corner() {
  VoxelGrid grid = whole(5, 4, 4);
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 5; ++x)
        grid.occupied[std::size_t(x + 5 * (y + 4 * z))] =
            !(x >= 2 && y >= 2) && !(x == 0 && y == 0 && z >= 2);
  return grid;
}

/// Largest error of displacements and turns in a patch test, over the largest displacement.
double patch_error(Problem problem, const Eigen::Matrix3d& stress, double nu) {
  fixture::load_faces(problem, nu,
                      [&](const Vec&, const Vec& normal) { return Vec(stress * normal); });
  const Eigen::Matrix3d strain =
      (stress - nu / (1 + nu) * stress.trace() * Eigen::Matrix3d::Identity()) / (2 * mu);
  problem.clamps = {{0, dof_all}};
  StaticSystem system(problem, Rotation::linearised);
  const Equilibrium found = find_equilibrium(system, {.solver = SolverKind::direct});
  EXPECT_TRUE(found.is_found) << found.reason;
  const std::vector<double> state = system.fields(found.state);
  const auto place = [&](const Row& row, int x) { return fixture::rest_place(problem, row, x); };
  const Vec origin = place(problem.lattice.rows[0], problem.lattice.rows[0].x_begin);
  double error = 0, largest = 0;
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const Vec exact = strain * (place(row, x) - origin);
    const double* fields = &state[e * field_count];
    largest = std::max(largest, exact.norm());
    error = std::max(error, (Vec(fields + ux) - exact).norm());
    error = std::max(error, problem.bodies[0].edge[0] * Vec(fields + qx).norm());
  });
  return error / largest;
}

Eigen::Matrix3d symmetric(double xx, double yy, double zz, double xy, double xz, double yz) {
  Eigen::Matrix3d s;
  s << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return s;
}

TEST(Pressure, patch_tests_are_exact) {
  const Eigen::Matrix3d stresses[] = {symmetric(1, 0, 0, 0, 0, 0), symmetric(0, 0, 0, 1, 0, 0),
                                      symmetric(0, 0, 0, 0, 0, 1), symmetric(-1, -1, -1, 0, 0, 0),
                                      symmetric(1, -.4, .3, .5, -.7, .2)};
  const std::pair<VoxelGrid, Vec3> bodies[] = {{whole(4, 3, 5), {0.01, 0.01, 0.01}},
                                               {corner(), {0.01, 0.01, 0.01}},
                                               {whole(4, 3, 5), {0.01, 0.007, 0.016}}};
  for (const double nu : {0.0, 0.3, 0.45, 0.49})
    for (const auto& [grid, edge] : bodies)
      for (const Eigen::Matrix3d& stress : stresses)
        EXPECT_LE(patch_error(contracting_solid(grid, edge, nu), stress, nu), 1e-12) << nu;
  EXPECT_LE(patch_error(contracting_solid(whole(4, 3, 1), {1, 1, 1}, 0.3), stresses[0], 0.3), 1e-12)
      << "a plate";
  EXPECT_LE(patch_error(contracting_solid(whole(6, 1, 1), {1, 1, 1}, 0.3), stresses[0], 0.3), 1e-12)
      << "a chain";
}

/// A deformed state with large turns, and a motion.
struct Deformed {
  std::vector<Real> state;
  std::vector<Vec> shift, turn; ///< of each element
};
Deformed deformed(std::size_t elements, double size, bool are_vectors) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&] { return Vec(number(random), number(random), number(random)); };
  Deformed all{std::vector<Real>(elements * field_count), {}, {}};
  for (std::size_t e = 0; e < elements; ++e) {
    const Vec u = 0.1 * size * vector(), turn = 0.3 * vector();
    for (int a = 0; a < 3; ++a) all.state[e * field_count + std::size_t(ux + a)] = u[a];
    reference::Orientation<Real> q;
    if (are_vectors)
      q.v = turn.cast<Real>();
    else
      q = reference::orientation_of_vector<Real>(turn.cast<Real>());
    reference::set_orientation_fields(&all.state[e * field_count], q);
    all.shift.push_back(size * vector());
    all.turn.push_back(vector());
  }
  return all;
}
std::vector<Real> moved(const Deformed& from, double by, bool are_vectors) {
  std::vector<Real> state = from.state;
  for (std::size_t e = 0; e < from.shift.size(); ++e) {
    Real* fields = &state[e * field_count];
    for (int a = 0; a < 3; ++a) fields[ux + a] += by * from.shift[e][a];
    reference::Orientation<Real> q = reference::orientation_fields(fields);
    const auto turn = (by * from.turn[e]).cast<Real>().eval();
    if (are_vectors)
      q.v += turn;
    else
      q = reference::product(reference::orientation_of_vector<Real>(turn), q);
    reference::set_orientation_fields(fields, q);
  }
  return state;
}

TEST(Pressure, forces_and_moments_are_those_of_the_energy) {
  for (const VoxelGrid& grid : {whole(3, 2, 2), whole(3, 3, 1), whole(1, 3, 3), corner()})
    for (const Rotation rotation : {Rotation::quaternion, Rotation::linearised}) {
      const Problem problem = contracting_solid(grid, {1, 0.9, 0.8}, 0.4);
      const bool are_vectors = rotation == Rotation::linearised;
      const Deformed at = deformed(problem.lattice.element_count, 1, are_vectors);
      reference::Dynamics<Real> dynamics(problem, rotation);
      std::vector<Real> wrenches(6 * at.shift.size());
      const std::vector<double> signals(3, 0.0);
      dynamics.wrenches(at.state, signals, wrenches);
      Real work = 0;
      for (std::size_t e = 0; e < at.shift.size(); ++e)
        for (std::size_t a = 0; a < 3; ++a)
          work += wrenches[6 * e + a] * Real(at.shift[e][Eigen::Index(a)]) +
                  wrenches[6 * e + 3 + a] * Real(at.turn[e][Eigen::Index(a)]);
      constexpr double by = 1e-5;
      const Real slope = (dynamics.energy(moved(at, by, are_vectors)) -
                          dynamics.energy(moved(at, -by, are_vectors))) /
                         (2 * by);
      EXPECT_NEAR(double(-work / slope), 1, 1e-8) << name(rotation);
    }
}

TEST(Pressure, rigid_motion_changes_no_energy) {
  const Problem problem = contracting_solid(corner(), {1, 0.9, 0.8}, 0.3);
  Deformed at = deformed(problem.lattice.element_count, 1, false);
  reference::Dynamics<Real> dynamics(problem);
  const Real before = dynamics.energy(at.state);
  const reference::Vector<Real> turn(0.9L, -1.3L, 0.7L);
  const auto q = reference::orientation_of_vector<Real>(turn);
  const reference::Matrix<Real> rotation = reference::Matrix<Real>::Identity() + reference::turn(q);
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    Real* fields = &at.state[e * field_count];
    const Vec3 rest = rest_position(problem, row, x);
    const reference::Vector<Real> place{Real(rest[0]), Real(rest[1]), Real(rest[2])};
    reference::Vector<Real> u(fields[ux], fields[uy], fields[uz]);
    u = rotation * (place + u) - place;
    for (int a = 0; a < 3; ++a) fields[ux + a] = u[a];
    reference::set_orientation_fields(fields,
                                      reference::product(q, reference::orientation_fields(fields)));
  });
  EXPECT_NEAR(double(dynamics.energy(at.state) / before), 1, 1e-14);
}

TEST(Pressure, matrices_at_rest_are_the_tangent_of_the_forces) {
  for (const VoxelGrid& grid : {corner(), whole(4, 3, 1)}) {
    const Problem problem = contracting_solid(grid, {1, 0.9, 0.8}, 0.45);
    StaticSystem system(problem);
    const Eigen::MatrixXd exact = Eigen::MatrixXd(system.stiffness_at_rest()),
                          tangent = Eigen::MatrixXd(system.tangent(system.rest()));
    EXPECT_LE((exact - tangent).norm() / exact.norm(), 1e-9);
  }
}

TEST(Pressure, tangent_of_a_strained_body_is_the_slope_of_its_forces) {
  const Problem problem = contracting_solid(whole(3, 2, 1), {1, 0.9, 0.8}, 0.45);
  StaticSystem system(problem);
  StaticSystem::State state = system.rest();
  const Deformed at = deformed(problem.lattice.element_count, 1e-3, false);
  Eigen::VectorXd start(system.size()), step(system.size());
  for (std::size_t e = 0; e < at.shift.size(); ++e)
    for (Eigen::Index a = 0; a < 3; ++a) {
      start[Eigen::Index(6 * e) + a] = 0.05 * 1e3 * at.shift[e][a];
      start[Eigen::Index(6 * e) + 3 + a] = 0.05 * at.turn[e][a];
      step[Eigen::Index(6 * e) + a] = at.turn[e][a];
      step[Eigen::Index(6 * e) + 3 + a] = 1e3 * at.shift[e][a];
    }
  system.move(state, start);
  StaticSystem::State up = state, down = state;
  constexpr double by = 1e-6;
  system.move(up, by * step), system.move(down, -by * step);
  const Eigen::VectorXd slope =
      ((system.unbalanced(down) - system.unbalanced(up)) / (2 * by)).cast<double>();
  const Eigen::SparseMatrix<double> lower = system.tangent(state);
  // The tangent is the symmetric part; so are the quadratic forms.
  const double form = step.dot(lower.selfadjointView<Eigen::Lower>() * step);
  EXPECT_NEAR(form / step.dot(slope), 1, 1e-7);
}

TEST(Pressure, free_blocks_have_six_motions_without_energy) {
  for (const VoxelGrid& grid : {whole(4, 3, 3), whole(4, 3, 1), whole(5, 1, 1)})
    for (const double nu : {0.3, 0.49}) {
      const Problem problem = contracting_solid(grid, {1, 1, 1}, nu);
      const StaticSystem system(problem);
      const Eigen::MatrixXd lower(system.stiffness_at_rest());
      const Eigen::VectorXd values =
          SymmetricEigen(Eigen::MatrixXd(lower.selfadjointView<Eigen::Lower>())).values;
      const double most = values[values.size() - 1];
      for (Eigen::Index n = 0; n < values.size(); ++n)
        EXPECT_EQ(values[n] > 1e-9 * most, n >= 6) << nu << " value " << n;
      EXPECT_GT(values[0], -1e-9 * most);
    }
}

// The other methods take what they need of damping from this bound (stability.cpp).
TEST(Pressure, every_mode_is_damped_as_much_as_the_spectrum_promises) {
  Material material = fixture::contracting(0.45);
  material.damping_ratio = 0.05;
  Problem problem = fixture::empty_problem("damped");
  fixture::add_block(problem, contracting_solid(whole(1, 1, 1), {1, 1, 1}, 0).bodies[0], 4, 3, 3);
  problem.bodies[0].axis = {};
  set_solid_links({{material}, {}}, problem);
  const double b = krylov_spectrum(problem).least_damping;
  EXPECT_GT(b, 0);
  const StaticSystem system(problem);
  const Eigen::MatrixXd lower(system.stiffness_at_rest()),
      stiffness(lower.selfadjointView<Eigen::Lower>());
  Eigen::MatrixXd rest = -b * stiffness;
  const Linearised linear(problem);
  for (const auto& [i, j, kind] : linear.links) {
    const Eigen::Index at[] = {Eigen::Index(6 * i), Eigen::Index(6 * j)};
    for (Eigen::Index r = 0; r < 2; ++r)
      for (Eigen::Index c = 0; c < 2; ++c)
        rest.block<6, 6>(at[r], at[c]) += linear.kinds[kind].c.block<6, 6>(6 * r, 6 * c);
  }
  EXPECT_GE(SymmetricEigen(rest).values[0], -1e-12 * rest.norm());
}

TEST(Pressure, acts_to_first_order_under_small_rotations_as_under_linearised_ones) {
  const Problem problem = contracting_solid(corner(), {1, 0.9, 0.8}, 0.4);
  const Deformed at = deformed(problem.lattice.element_count, 1, true);
  std::vector<Real> little = at.state;
  for (Real& number : little) number *= 1e-6L;
  std::vector<Real> wrenches[2];
  const std::vector<double> signals(3, 0.0);
  for (const int n : {0, 1}) {
    reference::Dynamics<Real> dynamics(problem, n == 0 ? Rotation::small : Rotation::linearised);
    wrenches[n].resize(6 * at.shift.size());
    dynamics.wrenches(little, signals, wrenches[n]);
  }
  Real largest = 0, difference = 0;
  for (std::size_t n = 0; n < wrenches[0].size(); ++n) {
    largest = std::max(largest, std::abs(wrenches[0][n]));
    difference = std::max(difference, std::abs(wrenches[0][n] - wrenches[1][n]));
  }
  EXPECT_LE(double(difference / largest), 1e-5);
  EXPECT_GT(double(difference), 0);
}

TEST(Pressure, loads_on_faces_leave_the_smaller_models) {
  const Eigen::Matrix3d pressed = symmetric(0, 0, -1, 0, 0, 0);
  Problem plate = contracting_solid(whole(4, 3, 1), {1, 1, 1}, 0.3);
  EXPECT_TRUE(why_not(Model::bending, plate).empty());
  EXPECT_TRUE(why_not(Model::planar, plate).empty());
  EXPECT_FALSE(why_not(Model::axial, plate).empty());
  EXPECT_TRUE(why_not_in_translation(plate).empty());
  fixture::load_faces(plate, 0.3, [&](const Vec&, const Vec& n) { return Vec(pressed * n); });
  EXPECT_NE(why_not(Model::bending, plate).find("presses on faces"), std::string::npos);
  EXPECT_NE(why_not_in_translation(plate), "");
}

// Leissa 1973: omega a^2 sqrt(rho t / D) = 13.47, 19.60, 24.27, which 32 x 32 elements reach within
// 1.3 %. On 8 x 8 an independent program (shared/solid.md) has the figures of this test.
TEST(Pressure, free_plates_of_one_and_two_layers_have_the_frequencies_of_an_independent_program) {
  constexpr double thickness = 0.02, nu = 0.3;
  const std::array<double, 3> expected[] = {{12.85, 19.45, 24.00}, {12.84, 19.40, 23.76}};
  for (const int layers : {1, 2}) {
    const Problem plate =
        contracting_solid(whole(8, 8, layers), {0.125, 0.125, thickness / layers}, nu);
    const StaticSystem system(plate);
    const Eigen::VectorXd scale =
        Eigen::MatrixXd(system.mass(system.rest())).diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd lower(system.stiffness_at_rest()),
        whole_matrix(lower.selfadjointView<Eigen::Lower>());
    const Eigen::VectorXd values =
        SymmetricEigen(Eigen::MatrixXd(scale.asDiagonal() * whole_matrix * scale.asDiagonal()))
            .values;
    const double D = 2 * mu * (1 + nu) * std::pow(thickness, 3) / (12 * (1 - nu * nu)),
                 unit = std::sqrt(D / (1e3 * thickness));
    for (Eigen::Index n = 0; n < 3; ++n)
      EXPECT_NEAR(std::sqrt(values[6 + n]) / unit,
                  expected[std::size_t(layers - 1)][std::size_t(n)], 0.006)
          << layers << " layers";
  }
}

// omega^2 = max(28 mu, 12 mu + 3 lambda) / (rho h^2) for cubes, in the limit of large blocks.
TEST(Pressure, step_limit_follows_nu) {
  for (const double nu : {0.0, 0.3, 0.45, 0.49}) {
    const Problem block = contracting_solid(whole(6, 6, 6), {1, 1, 1}, nu);
    const double lambda = 2 * mu * nu / (1 - 2 * nu),
                 most = std::sqrt(std::max(28 * mu, 12 * mu + 3 * lambda) / 1e3);
    const double found = krylov_spectrum(block).omega_max;
    EXPECT_LE(found, 1.001 * most) << nu;
    EXPECT_GE(found, 0.85 * most) << nu;
    EXPECT_GE(spectrum_bound(block).omega_max, 0.999 * found) << nu;
  }
}

} // namespace
} // namespace dss
