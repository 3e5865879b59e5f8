/// Stress at a curved surface that a grid has in steps.
#include "tests/fixtures/stresses.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <array>
#include <cmath>
#include <vector>

namespace dss::test {
namespace {

/// Plane stress beside a hole of radius 1 in an infinite plate under the tension 1 along x
/// (Kirsch).
Eigen::Matrix3d kirsch(const Eigen::Vector3d& at) {
  const double r2 = at.x() * at.x() + at.y() * at.y(), t = std::atan2(at.y(), at.x()), a = 1 / r2;
  const double rr = (1 - a) / 2 + (1 - 4 * a + 3 * a * a) / 2 * std::cos(2 * t),
               tt = (1 + a) / 2 - (1 + 3 * a * a) / 2 * std::cos(2 * t),
               rt = -(1 + 2 * a - 3 * a * a) / 2 * std::sin(2 * t);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(t, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return turn * fixture::symmetric(rr, tt, 0, rt, 0, 0) * turn.transpose();
}

constexpr int half_plate = 3; ///< edge of the plate, in radii

/// A plate with such a hole, cut out of it.
Problem holed_plate(int per_radius) {
  const int count = 2 * half_plate * per_radius;
  const double edge = 1.0 / per_radius;
  VoxelGrid grid = fixture::whole_grid(count, count, 1);
  const auto middle = [&](int cell) { return (cell + 0.5) * edge - half_plate; };
  for (int y = 0; y < count; ++y)
    for (int x = 0; x < count; ++x)
      if (std::hypot(middle(x), middle(y)) < 1) grid.occupied[std::size_t(y * count + x)] = 0;
  Problem plate = fixture::contracting_solid(grid, {edge, edge, edge}, 0.3);
  plate.bodies[0].origin = {-half_plate, -half_plate, -edge / 2};
  fixture::load_faces(plate, 0.3, [&](const Eigen::Vector3d& at, const Eigen::Vector3d& n) {
    const bool is_outer =
        std::abs(at.x()) > 0.99 * half_plate || std::abs(at.y()) > 0.99 * half_plate;
    return is_outer ? Eigen::Vector3d(kirsch(at) * n) : Eigen::Vector3d(0, 0, 0);
  });
  plate.clamps = {{0, dof_all}};
  return plate;
}

/// Relative errors of the stress at the crown of the hole, which is 3.
struct CrownErrors {
  double node, extrapolated;
};
/// Extrapolated: a cubic through the stresses of elements, by least squares, over the distances
/// 0.15 to 0.65 from the hole along its normal.
CrownErrors crown_errors(int per_radius) {
  const Problem plate = holed_plate(per_radius);
  const StressField field = fixture::stress_at_rest(plate, dof_ux | dof_uy | dof_rz);
  const ElementNodes nodes(plate.lattice);
  const std::vector<SymmetricTensor> at_nodes = field.at_nodes(nodes);
  std::vector<std::array<double, 2>> points;
  double crown = 0;
  plate.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    const Eigen::Vector3d at = fixture::rest_place(plate, row, x);
    const double edge = 1.0 / per_radius, distance = at.y() - 1;
    if (std::abs(at.x()) > edge) return;
    if (std::abs(distance - edge / 2) < edge / 4)
      crown = at_nodes[nodes.of(e)[at.x() < 0 ? 1 : 0]][0];
    if (distance > 0.15 && distance < 0.65) points.push_back({distance, field.of(e).stress[0]});
  });
  Eigen::MatrixXd powers(points.size(), 4);
  Eigen::VectorXd stress(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double d = points[k][0];
    powers.row(Eigen::Index(k)) << 1, d, d * d, d * d * d;
    stress[Eigen::Index(k)] = points[k][1];
  }
  const Eigen::VectorXd cubic = powers.colPivHouseholderQr().solve(stress);
  return {crown / 3 - 1, cubic[0] / 3 - 1};
}

TEST(StressAtHole, converges_by_extrapolation_along_the_normal_alone) {
  const CrownErrors coarse = crown_errors(8), fine = crown_errors(16);
  EXPECT_LT(coarse.node, -0.1);
  EXPECT_LT(fine.node, -0.1);
  EXPECT_LT(std::abs(fine.extrapolated), 0.13);
  EXPECT_GT(coarse.extrapolated / fine.extrapolated, 1.7);
}

} // namespace
} // namespace dss::test
