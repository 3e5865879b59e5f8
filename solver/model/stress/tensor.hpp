#pragma once
/// Symmetric tensors: stress and strain.
#include "solver/model/problem.hpp"

#include <Eigen/Core>

#include <array>

namespace dss {

/// xx, yy, zz, yz, xz, xy, in global axes.
using SymmetricTensor = std::array<double, 6>;

/// Equivalent stress of von Mises, of a stress tensor (kernels/stress/stress.h).
double von_mises(const SymmetricTensor& stress);

/// Principal values, the largest first.
Vec3 principal_values(const SymmetricTensor& tensor);

Eigen::Matrix3d matrix_of(const SymmetricTensor& tensor);
/// The symmetric part of a matrix.
SymmetricTensor symmetric_part(const Eigen::Matrix3d& matrix);

inline void add_scaled(double factor, const SymmetricTensor& from, SymmetricTensor& to) {
  for (std::size_t c = 0; c < to.size(); ++c) to[c] += factor * from[c];
}

} // namespace dss
