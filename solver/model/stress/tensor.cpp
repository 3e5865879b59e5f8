#include "solver/model/stress/tensor.hpp"

#include "kernels/physics.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace dss {

double von_mises(const SymmetricTensor& stress) {
  using Spatial = Physics<Model::spatial, double>;
  const auto& [xx, yy, zz, yz, xz, xy] = stress;
  return std::sqrt(Spatial::von_mises_squared({xx, yy, zz, yz, xz, xy}));
}

Vec3 principal_values(const SymmetricTensor& tensor) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix_of(tensor),
                                                              Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& ascending = solver.eigenvalues();
  return {ascending[2], ascending[1], ascending[0]};
}

Eigen::Matrix3d matrix_of(const SymmetricTensor& tensor) {
  const auto& [xx, yy, zz, yz, xz, xy] = tensor;
  Eigen::Matrix3d matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return matrix;
}

SymmetricTensor symmetric_part(const Eigen::Matrix3d& m) {
  return {m(0, 0),
          m(1, 1),
          m(2, 2),
          (m(1, 2) + m(2, 1)) / 2,
          (m(0, 2) + m(2, 0)) / 2,
          (m(0, 1) + m(1, 0)) / 2};
}

} // namespace dss
