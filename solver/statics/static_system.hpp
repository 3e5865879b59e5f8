#pragma once
/// A problem without motion: which degrees of freedom are unknown, the forces that are left on them, and how these change.
///
/// Loads and the frame's acceleration are as they are at the end of the problem's run; dampers do nothing. Forces come from the oracle's
/// link laws in long double, so that stiffnesses found by differences keep ten digits and no formula of the links is used twice.
#include "solver/model/model.hpp"
#include "solver/model/problem.hpp"
#include "solver/reference/dynamics.hpp"

#include <Eigen/SparseCore>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dss {

using SparseMatrix = Eigen::SparseMatrix<double>; ///< of a symmetric one the lower half alone

/// The free degrees of freedom of a problem.
struct FreeDofs {
  std::vector<Eigen::Index> index; ///< of each degree of freedom (6 an element), -1 where it does not move
  std::vector<std::size_t> dof;    ///< the other way round: 6 element + 0 .. 5
  Eigen::Index size() const { return Eigen::Index(dof.size()); }
};
/// Those of `dofs` that are not clamped. @throws InputError where there are none
FreeDofs free_dofs(const Problem& problem, std::uint8_t dofs = dof_all);

/// "uz of element 7 of body "plate"", for messages. @param dof  6 element + 0 .. 5
std::string dof_text(const Problem& problem, std::size_t dof);

class StaticSystem {
public:
  using Real = long double; // differences lose half of the digits
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  /// Fields of all elements, as the oracle has them inside for the law's Rotation; velocities are zero.
  using State = std::vector<Real>;

  /// @param law    Rotation::quaternion, linearised or small  @param dofs  bits of Dof that may move
  /// @param loads  the loads and the frame's acceleration are multiplied by it
  explicit StaticSystem(const Problem& problem, Rotation law = Rotation::quaternion, std::uint8_t dofs = dof_all,
                        double loads = 1);

  const Problem& problem() const { return problem_; }
  const FreeDofs& dofs() const { return dofs_; }
  Eigen::Index size() const { return dofs_.size(); }
  std::uint8_t moving() const { return moving_; } ///< bits of Dof
  bool is_linear() const { return dynamics_.coordinates().rotation() == Rotation::linearised; }

  State rest() const { return State(problem_.lattice.element_count * field_count, 0); }
  /// From and to fields as they are outside of the oracle; velocities become zero.
  State inside(std::span<const double> fields);
  std::vector<double> fields(const State& state) const;

  /// Forces and moments on the free degrees of freedom, of links and ties, and of `share` of the loads [N, N m].
  Vector unbalanced(const State& state, double share = 1);
  /// Adds displacements [m] and turns about axes in space [rad] of the free degrees of freedom.
  void move(State& state, const Eigen::VectorXd& step) const;

  /// Stiffness at rest, exact: from the matrices of the links (solver/numerics/linearised.hpp).
  SparseMatrix stiffness_at_rest() const;
  /// Minus the slope of the unbalanced forces at a state, by central differences link by link; its symmetric part, which is all of it at an
  /// equilibrium under forces that have a potential.
  SparseMatrix tangent(const State& state) const;
  /// Masses and moments of inertia about axes in space, of elements turned as in `state`.
  SparseMatrix mass(const State& state) const;

  /// Length of a vector of forces, moments over the shortest edge of an element [N].
  double norm(const Vector& forces) const;
  /// That of all loads and of the frame's acceleration on the free degrees of freedom [N].
  double load_norm() const;
  /// Unbalanced forces of a state against the loads, by their norms; where nothing is loaded the forces themselves [N].
  double residual(const State& state);

private:
  using Link = reference::Dynamics<Real>::Link;
  void turn_fields(Real* fields, const reference::Vector<Real>& turn) const;
  Vector free_part(const std::vector<Real>& all) const;
  Eigen::Matrix<double, 12, 12> link_stiffness(const Link& link, const State& state) const;

  const Problem& problem_;
  std::uint8_t moving_;
  FreeDofs dofs_;
  reference::Dynamics<Real> dynamics_;
  std::vector<double> signals_;
  std::vector<int> body_; ///< of each element
  double edge_;
};

/// The problem as it is at the end of its run, for ever: loads are constant, and what the frame's acceleration does to masses is a load.
Problem held_still(const Problem& problem, double loads = 1);

} // namespace dss
