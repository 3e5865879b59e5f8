/// Plane waves inside of a solid: their speeds are those of the material in every direction.
#include "solver/reference/dynamics.hpp"
#include "tests/fixtures/solids.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace dss::test {
namespace {

constexpr double spacing = 0.01;
constexpr int across = 7; // elements, so that the middle one has whole neighbours

/// The linear equations of a block, of which only the middle element is looked at.
class InnerElement {
public:
  explicit InnerElement(double nu)
      : block_(fixture::contracting_solid(fixture::whole_grid(across, across, across),
                                          {spacing, spacing, spacing}, nu)),
        terms_(block_, Rotation::linearised) {}

  /// Squares of the frequencies of waves with the wave vector k [1/m], ascending.
  Eigen::VectorXd squares(const Eigen::Vector3d& k) {
    Eigen::Matrix<std::complex<double>, 6, 6> matrix;
    for (int dof = 0; dof < 6; ++dof) {
      const auto even = response(k, dof, [](double phase) { return std::cos(phase); }),
                 odd = response(k, dof, [](double phase) { return std::sin(phase); });
      for (int row = 0; row < 6; ++row) matrix(row, dof) = {-even[row], -odd[row]};
    }
    const Eigen::ComplexEigenSolver<decltype(matrix)> solver(matrix, false);
    Eigen::VectorXd squares = solver.eigenvalues().real();
    std::sort(squares.begin(), squares.end());
    return squares;
  }

private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  /// Accelerations of the middle element if one degree of freedom has the given wave.
  template <class Wave>
  Vector6 response(const Eigen::Vector3d& k, int dof, Wave&& wave) {
    const std::size_t count = block_.lattice.element_count, middle = count / 2;
    const Eigen::Vector3d centre = spacing * across / 2 * Eigen::Vector3d::Ones();
    std::vector<double> state(count * field_count), rates(state);
    block_.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
      const double size = wave(k.dot(fixture::rest_place(block_, row, x) - centre));
      state[e * field_count + std::size_t(dof < 3 ? ux + dof : qx + dof - 3)] = size;
    });
    const std::vector<double> signals(3);
    terms_.rates(state, signals, rates);
    Vector6 found;
    for (int row = 0; row < 6; ++row)
      found[row] = rates[middle * field_count + std::size_t(row < 3 ? vx + row : wx + row - 3)];
    return found;
  }

  Problem block_;
  reference::Dynamics<double> terms_;
};

TEST(Waves, have_the_speeds_of_the_material_in_every_direction) {
  const Eigen::Vector3d directions[] = {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {2, 1, 0}};
  for (const double nu : {0.0, 0.3, 0.45}) {
    InnerElement element(nu);
    const double shear = fixture::solid_mu / fixture::solid_rho, // squares of speeds
        pressure = shear * (2 - 2 * nu) / (1 - 2 * nu);
    for (const Eigen::Vector3d& direction : directions) {
      const Eigen::Vector3d k = 0.05 / spacing * direction.normalized();
      const Eigen::VectorXd squares = element.squares(k);
      const double k2 = k.squaredNorm();
      EXPECT_NEAR(std::sqrt(squares[0] / k2 / shear), 1, 4e-4) << nu << ": " << direction;
      EXPECT_NEAR(std::sqrt(squares[1] / k2 / shear), 1, 4e-4) << nu << ": " << direction;
      EXPECT_NEAR(std::sqrt(squares[2] / k2 / pressure), 1, 4e-4) << nu << ": " << direction;
      EXPECT_GT(squares[3], 100 * squares[2]); // turns of the elements
    }
  }
}

} // namespace
} // namespace dss::test
