#pragma once
/// The equations of a step of the implicit midpoint rule and their solution by Newton's iteration.
#include "solver/reference/dynamics.hpp"

#include <Eigen/SparseLU>

#include <optional>
#include <span>
#include <vector>

namespace dss::reference {

/// y_{n+1} = y_n + h f(t_n + h/2, (y_n + y_{n+1}) / 2), solved to rounding of T.
///
/// Unknown are only the changes z of velocities (v, w) over the step, six an element: they give v_mid = v_n + z/2,
/// u_mid = u_n + h/2 v_mid, and by the kinematic equation alone (Coordinates::midpoint) the orientation half-way. What
/// remains is z = h a(mid), in numbers of one kind: no stiffness stands beside a displacement of a micrometre.
///
/// The Jacobian I - h da/dz comes from differences, all elements of a colour at once. Its LU factors are in double
/// whatever T is: they decide how fast the iteration converges, not to what. They serve further iterations and steps
/// until the iteration is slow.
template <class T>
class ImplicitMidpoint {
public:
  /// `dt` is the step [s].
  ImplicitMidpoint(const Problem& problem, double dt);

  /// Forgets the steps before: the next one does not depend on them to the last bit.
  void restart();

  /// Takes `state` one step on with the signals at its middle.
  /// @return nothing, or the element furthest from a solution where the iteration found none; then `state` is as before
  std::optional<std::size_t> step(Dynamics<T>& dynamics, std::span<T> state, std::span<const double> signals);

  /// Jacobians factorised since the restart.
  long factorisations() const { return factorisations_; }
  std::size_t bytes() const;

private:
  using Unknowns = Eigen::Matrix<T, Eigen::Dynamic, 1>;

  bool solve(Dynamics<T>& dynamics, std::span<const T> state, std::span<const double> signals);
  void place_middle(const Dynamics<T>& dynamics, std::span<const T> state, std::size_t e);
  void find_residual(Dynamics<T>& dynamics, std::span<const T> state, std::span<const double> signals);
  bool find_jacobian(Dynamics<T>& dynamics, std::span<const T> state, std::span<const double> signals);
  Unknowns correction() const;
  T speed(const Unknowns& changes) const;
  T speed_from_rounding(std::span<const T> state) const;
  std::size_t worst_element() const;
  void finish(const Dynamics<T>& dynamics, std::span<T> state) const;

  T dt_;
  std::vector<std::vector<std::size_t>> neighbourhoods_, groups_;
  std::vector<T> gyration_; ///< radius of gyration of each element [m]: what makes w comparable with v
  std::vector<T> edge_;     ///< largest edge of each element [m]
  Unknowns change_;         ///< z of the iteration, and the first guess of the next step
  Unknowns residual_;       ///< z - h a(mid) at change_
  std::vector<T> mid_, rates_, disturbed_rates_; ///< fields of all elements half-way, and their rates
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors_;
  bool has_factors_ = false;
  long factorisations_ = 0;
};

} // namespace dss::reference
