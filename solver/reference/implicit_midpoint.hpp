#pragma once
/// Equations of a step of the implicit midpoint rule, or of a stage of any diagonally implicit
/// method, and Newton's iteration for them.
#include "solver/reference/dynamics.hpp"

#include <Eigen/SparseLU>

#include <optional>
#include <span>
#include <vector>

namespace dss::reference {

/// y_{n+1} = y_n + h f(t_n + h/2, (y_n + y_{n+1}) / 2), solved to the rounding of T.
///
/// The unknowns are the changes z of the velocities (v, w) over the step, six an element. They give
/// v_mid = v_n + z/2 and u_mid = u_n + h/2 v_mid. The kinematic equation (Coordinates::midpoint)
/// gives the orientation in the middle. The equations left are z = h a(mid). All unknowns are
/// velocities, so no stiffness stands beside a displacement of a micrometre.
///
/// The Jacobian I - h da/dz is computed by differences, all elements of a colour at once. Its LU
/// factors are in double for every T: they determine how fast the iteration converges, not the
/// result. Later iterations and steps use the same factors until the iteration is slow.
template <class T>
class ImplicitMidpoint {
public:
  /// `dt` is the step [s].
  ImplicitMidpoint(const Problem& problem, double dt);

  /// Forgets earlier steps, so that the next step does not depend on them in any bit.
  void restart();

  /// Advances `state` by one step, with the signals at its middle.
  /// @return nothing; or, if the iteration found no solution, the element with the largest
  ///     residual, and `state` is unchanged
  std::optional<std::size_t> step(Dynamics<T>& dynamics, std::span<T> state,
                                  std::span<const double> signals);

  /// Solves Y = base + dt/2 f(Y), the first half of such a step.
  /// @param reached, slope  Y and f(Y), field_count numbers an element
  /// @return as step; then `reached` and `slope` are unchanged
  std::optional<std::size_t> stage(Dynamics<T>& dynamics, std::span<const T> base,
                                   std::span<const double> signals, std::span<T> reached,
                                   std::span<T> slope);

  /// Number of Jacobians factorised since the restart.
  long factorisations() const { return factorisations_; }
  std::size_t bytes() const;

private:
  using Unknowns = Eigen::Matrix<T, Eigen::Dynamic, 1>;

  std::optional<std::size_t> solve_or_worst(Dynamics<T>& dynamics, std::span<const T> state,
                                            std::span<const double> signals);
  bool solve(Dynamics<T>& dynamics, std::span<const T> state, std::span<const double> signals);
  void place_middle(const Dynamics<T>& dynamics, std::span<const T> state, std::size_t e);
  void find_residual(Dynamics<T>& dynamics, std::span<const T> state,
                     std::span<const double> signals);
  bool find_jacobian(Dynamics<T>& dynamics, std::span<const T> state,
                     std::span<const double> signals);
  Unknowns correction() const;
  T speed(const Unknowns& changes) const;
  T speed_from_rounding(std::span<const T> state) const;
  std::size_t worst_element() const;
  void finish(const Dynamics<T>& dynamics, std::span<T> state) const;

  T dt_;
  std::vector<std::vector<std::size_t>> neighbourhoods_, groups_;
  /// Radius of gyration of each element [m]; it makes w comparable with v.
  std::vector<T> gyration_;
  std::vector<T> edge_; ///< largest edge of each element [m]
  Unknowns change_;     ///< z of the iteration; first guess of the next step
  Unknowns residual_;   ///< z - h a(mid) at change_
  /// Fields of all elements in the middle of the step, and their rates.
  std::vector<T> mid_, rates_, disturbed_rates_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors_;
  bool has_factors_ = false;
  long factorisations_ = 0;
};

} // namespace dss::reference
