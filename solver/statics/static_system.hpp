#pragma once
/// A problem without motion: its unknown degrees of freedom, the unbalanced forces on them, and the
/// derivatives of these forces.
///
/// Loads and the frame's acceleration are those at the end of the problem's run. Dampers have no
/// effect. Forces and their derivatives come from the oracle's link laws, so no link formula exists
/// twice.
#include "kernels/model.hpp"
#include "solver/model/problem.hpp"
#include "solver/numerics/linearised.hpp"
#include "solver/reference/dynamics.hpp"
#include "solver/reference/link_slope.hpp"

#include <Eigen/SparseCore>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dss {

using SparseMatrix = Eigen::SparseMatrix<double>; ///< a symmetric matrix stores only its lower half

/// The free degrees of freedom of a problem.
struct FreeDofs {
  /// Unknown of each degree of freedom (6 an element); -1 if it does not move.
  std::vector<Eigen::Index> index;
  std::vector<std::size_t> dof; ///< degree of freedom of each unknown: 6 element + 0 .. 5
  Eigen::Index size() const { return Eigen::Index(dof.size()); }
};
/// The degrees of freedom in `dofs` that are not clamped.
/// @throws InputError if there are none
FreeDofs free_dofs(const Problem& problem, std::uint8_t dofs = dof_all);

/// Returns e.g. "uz of element 7 of body "plate"", for messages.
/// @param dof  6 element + 0 .. 5
std::string dof_text(const Problem& problem, std::size_t dof);

/// The equations of a static problem.
class StaticSystem {
public:
  using Real = long double; ///< unbalanced forces are small differences of large ones
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  /// Fields of all elements in the oracle's coordinates for the Rotation of the law. Velocities are
  /// zero.
  using State = std::vector<Real>;

  /// @param law    Rotation::quaternion, linearised or small
  /// @param dofs   bits of Dof that may move
  /// @param loads  factor on the loads and on the frame's acceleration
  /// @throws InputError if the frame rotates
  explicit StaticSystem(const Problem& problem, Rotation law = Rotation::quaternion,
                        std::uint8_t dofs = dof_all, double loads = 1);

  const Problem& problem() const { return problem_; }
  const FreeDofs& dofs() const { return dofs_; }
  Eigen::Index size() const { return dofs_.size(); }
  std::uint8_t moving() const { return moving_; } ///< bits of Dof
  bool is_linear() const { return dynamics_.coordinates().rotation() == Rotation::linearised; }

  State rest() const { return State(problem_.lattice.element_count * field_count, 0); }
  /// inside: a State from fields outside the oracle (kernels/fields.hpp), with zero velocities.
  /// fields: the inverse.
  State inside(std::span<const double> fields);
  std::vector<double> fields(const State& state) const;

  /// Forces and moments of links, ties and `share` of the loads on the free degrees of freedom [N,
  /// N m].
  Vector unbalanced(const State& state, double share = 1);
  /// Adds displacements [m] and turns about axes in space [rad] to the free degrees of freedom.
  void move(State& state, const Eigen::VectorXd& step) const;

  /// Stiffness at rest, exact, from the matrices of the links (solver/numerics/linearised.hpp).
  SparseMatrix stiffness_at_rest() const;
  /// Damping at rest, exact as well.
  SparseMatrix damping_at_rest() const;
  /// Minus the derivative of the unbalanced forces at a state, link by link, exact to rounding.
  /// Only the symmetric part: at an equilibrium under forces with a potential the derivative
  /// is symmetric.
  /// @param variation  of displacements and velocities; default: displacements alone
  SparseMatrix tangent(const State& state, const reference::Variation& variation = {}) const;
  /// Masses and moments of inertia about axes in space, with the elements turned as in `state`.
  SparseMatrix mass(const State& state) const;

  /// Norm of a vector of forces [N]. Moments are divided by the shortest edge of an element.
  double norm(const Vector& forces) const;
  /// Norm of all loads and of the frame's acceleration on the free degrees of freedom [N].
  double load_norm() const;
  /// Frame acceleration, then one value a load, as solver/numerics/signal_rows.hpp has them.
  std::span<const double> signals() const { return signals_; }
  /// Norm of the unbalanced forces of a state over load_norm(). Without loads, the norm itself [N].
  double residual(const State& state);

private:
  using Link = reference::Dynamics<Real>::Link;
  void turn_fields(Real* fields, const reference::Vector<Real>& turn) const;
  Vector free_part(const std::vector<Real>& all) const;
  reference::MovingLink moving_link(const Link& link, const State& state) const;
  std::vector<PressureTerm> pressure_terms(const State& state) const;

  const Problem& problem_;
  std::uint8_t moving_;
  FreeDofs dofs_;
  reference::Dynamics<Real> dynamics_;
  std::vector<double> signals_;
  std::vector<int> body_; ///< body of each element
  double edge_;
};

/// The problem with the state of its loads at the end of its run: loads are constant, and the
/// frame's acceleration acts as a load on the masses.
/// @param loads  factor on the loads
Problem held_still(const Problem& problem, double loads = 1);

} // namespace dss
