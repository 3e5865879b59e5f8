#include "solver/numerics/dense_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace dss {
namespace {
using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;
}

SymmetricEigen::SymmetricEigen(const Eigen::MatrixXd& matrix) {
  const Solver solved(matrix);
  values = solved.eigenvalues(), vectors = solved.eigenvectors();
}
SymmetricEigen::SymmetricEigen(const Eigen::VectorXd& diagonal,
                               const Eigen::VectorXd& off_diagonal) {
  Solver solved;
  solved.computeFromTridiagonal(diagonal, off_diagonal);
  values = solved.eigenvalues(), vectors = solved.eigenvectors();
}

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix) { return matrix.eigenvalues(); }
double spectral_radius(const Eigen::MatrixXd& matrix) {
  return eigenvalues(matrix).cwiseAbs().maxCoeff();
}

} // namespace dss
