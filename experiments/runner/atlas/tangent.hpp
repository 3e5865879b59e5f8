#pragma once
/// The equations of motion linearised at a state that is not rest: M x'' + K x = 0, six degrees of freedom an element, from differences of
/// the oracle's right-hand side. Prestress is in it, and no formula of the links is used twice.
#include "solver/model/problem.hpp"

#include <Eigen/SparseCore>

#include <vector>

namespace dss {

/// The free degrees of freedom of a problem and their inertia.
struct FreeDofs {
  std::vector<Eigen::Index> index; ///< of each degree of freedom (6 an element), -1 where it is clamped
  std::vector<std::size_t> dof;    ///< the other way round
  Eigen::VectorXd inertia;         ///< of each free one: mass [kg], principal moment [kg m^2]
};
FreeDofs free_dofs(const Problem& problem);

/// Minus the slope of the generalised forces over displacements (u, rotation vector about space) of the free degrees of freedom, at a state
/// without motion whose elements are not turned, or only a little; loads as at the end of the problem's run. Symmetric where forces have a
/// potential; its symmetric part is returned.
Eigen::SparseMatrix<double> tangent_stiffness(const Problem& problem, const FreeDofs& dofs,
                                              const std::vector<double>& state);

/// State at rest under the loads as they are at the end of the problem's run, by Newton's method from a given state.
/// @throws InputError if it does not converge
std::vector<double> equilibrium(const Problem& problem, const FreeDofs& dofs, std::vector<double> state);

/// The `count` smallest eigenvalues of (K, M) with M diagonal [rad^2/s^2], by subspace iteration (Bathe and Wilson) about `shift`, below which
/// there must be none. @throws InputError if it does not converge
Eigen::VectorXd smallest_eigenvalues(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& inertia,
                                     int count, double shift = 0);

} // namespace dss
