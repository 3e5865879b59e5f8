/// Solids with round holes against closed forms. Round boundaries are staircases of elements, so
/// displacements converge to first order (shared/solid.md has the same errors by an independent
/// program).
#include "solver/statics/equilibrium.hpp"
#include "tests/fixtures/solids.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dss {
namespace {

using Point3 = Eigen::Vector3d;

constexpr double holed_nu = 0.3, holed_E = 2 * fixture::solid_mu * (1 + holed_nu);

/// A square plate of one layer, with the cells whose centre is between two radii.
struct HoledPlate {
  HoledPlate(double half, double inner, double outer, int elements_a_unit) : centre(half, half, 0) {
    const int n = int(std::lround(2 * half * elements_a_unit));
    const double h = 1.0 / elements_a_unit;
    VoxelGrid grid{n, n, 1, {}};
    for (int cell = 0; cell < n * n; ++cell) {
      const double r = std::hypot((cell % n + 0.5) * h - half, (cell / n + 0.5) * h - half);
      grid.occupied.push_back(r > inner && r < outer);
    }
    problem = fixture::contracting_solid(grid, {h, h, h}, holed_nu);
  }
  Point3 from_centre(const Point3& place) const {
    return {place[0] - centre[0], place[1] - centre[1], 0};
  }
  Problem problem;
  Point3 centre;
};

struct Fit {
  double error;     ///< of all displacements, over the exact ones
  double amplitude; ///< of the exact displacements in those found
};

/// Solves a plate under tractions and compares it with exact displacements, apart from a rigid
/// motion.
template <class Traction, class Exact>
Fit compare(HoledPlate plate, Traction&& traction, Exact&& exact) {
  Problem& problem = plate.problem;
  fixture::load_faces(problem, holed_nu, [&](const Point3& place, const Point3& normal) {
    return normal[2] != 0 ? Point3(0, 0, 0) : Point3(traction(plate.from_centre(place), normal));
  });
  problem.clamps = {{0, dof_all}};
  for (std::size_t e = 1; e < problem.lattice.element_count; ++e)
    problem.clamps.push_back({e, std::uint8_t(dof_uz | dof_rx | dof_ry)});
  StaticSystem system(problem, Rotation::linearised);
  const Equilibrium found = find_equilibrium(system, {.solver = SolverKind::direct});
  EXPECT_TRUE(found.is_found) << found.reason;
  const std::vector<double> state = system.fields(found.state);
  const auto rows = Eigen::Index(2 * problem.lattice.element_count);
  Eigen::MatrixXd motions(rows, 4); // rigid ones, and the exact one
  Eigen::VectorXd all(rows);
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const Point3 at = plate.from_centre(fixture::rest_place(problem, row, x)), u = exact(at);
    const auto n = Eigen::Index(2 * e);
    all.segment<2>(n) << state[e * field_count + ux], state[e * field_count + uy];
    motions.row(n) << 1, 0, -at[1], u[0];
    motions.row(n + 1) << 0, 1, at[0], u[1];
  });
  const Eigen::VectorXd of_exact = motions.col(3);
  const Eigen::MatrixXd rigid = motions.leftCols(3);
  const auto without_rigid = [&](const Eigen::VectorXd& v) {
    return Eigen::VectorXd(v -
                           rigid * (rigid.transpose() * rigid).inverse() * (rigid.transpose() * v));
  };
  const Eigen::VectorXd mine = without_rigid(all);
  return {(mine - of_exact).norm() / of_exact.norm(), mine.dot(of_exact) / of_exact.squaredNorm()};
}

/// Kirsch 1898: an endless plate with a hole of radius 1 under the tension 1 Pa along x.
Fit kirsch(int elements_a_radius) {
  const auto stress = [](const Point3& at) {
    const double q = 1 / at.squaredNorm(), t = std::atan2(at[1], at[0]), c2 = std::cos(2 * t),
                 rr = (1 - q) / 2 + (1 - 4 * q + 3 * q * q) / 2 * c2,
                 tt = (1 + q) / 2 - (1 + 3 * q * q) / 2 * c2,
                 rt = -(1 + 2 * q - 3 * q * q) / 2 * std::sin(2 * t);
    Eigen::Matrix2d polar, axes;
    polar << rr, rt, rt, tt;
    axes << std::cos(t), -std::sin(t), std::sin(t), std::cos(t);
    return Eigen::Matrix2d(axes * polar * axes.transpose());
  };
  const auto exact = [](const Point3& at) {
    const double r = at.norm(), t = std::atan2(at[1], at[0]), r3 = r * r * r,
                 k = (3 - holed_nu) / (1 + holed_nu);
    const double x = r * (k + 1) * std::cos(t) + 2 / r * ((1 + k) * std::cos(t) + std::cos(3 * t)) -
                     2 / r3 * std::cos(3 * t),
                 y = r * (k - 3) * std::sin(t) + 2 / r * ((1 - k) * std::sin(t) + std::sin(3 * t)) -
                     2 / r3 * std::sin(3 * t);
    return Point3(Point3(x, y, 0) / (8 * fixture::solid_mu));
  };
  return compare(
      HoledPlate(4, 1, 99, elements_a_radius),
      [&](const Point3& at, const Point3& normal) {
        const bool is_outer = at.cwiseAbs().maxCoeff() > 4 - 1e-9;
        const Eigen::Vector2d t = stress(at) * normal.head<2>();
        return is_outer ? Point3(t[0], t[1], 0) : Point3(0, 0, 0);
      },
      exact);
}

/// Lame 1852: a ring of radii 1 and 2 under an inner pressure of 1 Pa, plane stress.
Fit lame(int elements_a_radius) {
  const auto exact = [](const Point3& at) {
    const double r = at.norm(), u = ((1 - holed_nu) * r + (1 + holed_nu) * 4 / r) / (3 * holed_E);
    return Point3(u / r * at);
  };
  return compare(
      HoledPlate(2.25, 1, 2, elements_a_radius),
      [](const Point3& at, const Point3& normal) {
        return at.norm() < 1.5 ? Point3(-normal) : Point3(0, 0, 0);
      },
      exact);
}

// The trial: 0.0472, 0.0291, 0.0143.
TEST(HoledBody, plate_with_a_hole_converges_to_kirsch) {
  const Fit coarse = kirsch(4), middle = kirsch(8), fine = kirsch(16);
  EXPECT_NEAR(coarse.error, 0.0472, 5e-4);
  EXPECT_NEAR(middle.error, 0.0291, 5e-4);
  EXPECT_NEAR(fine.error, 0.0143, 5e-4);
  EXPECT_NEAR(2 * fine.amplitude - middle.amplitude, 1, 0.005) << "extrapolated to first order";
}

// The trial: 0.3066, 0.1879, 0.0823.
TEST(HoledBody, ring_under_pressure_converges_to_lame) {
  const Fit coarse = lame(4), middle = lame(8), fine = lame(16);
  EXPECT_NEAR(coarse.error, 0.3066, 2e-3);
  EXPECT_NEAR(middle.error, 0.1879, 2e-3);
  EXPECT_NEAR(fine.error, 0.0823, 2e-3);
  const Fit finest = lame(32);
  EXPECT_NEAR(2 * finest.amplitude - fine.amplitude, 1, 0.005) << "extrapolated to first order";
}

} // namespace
} // namespace dss
