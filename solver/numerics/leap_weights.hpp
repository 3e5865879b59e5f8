#pragma once
/// Exact solutions of undamped linear problems as sums over the states of a simple method.
///
/// Displacements obey x'' = -A x + f(t). The highest frequency, the root of the largest eigenvalue
/// of A, is at most omega. Symplectic Euler steps of h = 2 / omega from rest are a recurrence of
/// Chebyshev polynomials: with c = 1 - h^2 A / 2,
///     x_n = V_n(c) x_0,   T_n = (V_n + V_{n-1}) / 2,   T_n(cos y) = cos n y
/// Jacobi's and Anger's expansion gives the exact solution after a leap of the length L, z = omega
/// L:
///     cos(L A^(1/2)) = J_0(z) + 2 sum_n J_2n(z) T_n(c)
/// Its integral over L gives what an initial velocity does. Its weights sum to 1, so that constant
/// loads need nothing more: the run of the method has them. A load that changes has a run with a
/// unit step of it, U_n, and adds sum_n U_n int_0^L g'(s) w_n(omega (L - s)) ds, w_n being the
/// weights above and g the load's signal.
/// Source: H. Tal-Ezer, SIAM J. Numer. Anal. 23 (1986) 11-26, for the expansion.
#include <cstddef>
#include <span>
#include <vector>

namespace dss {

/// For the states n = 0, 1, ... of a run.
struct StateWeights {
  std::vector<double> displacement; ///< what displacements x_n add to displacements
  std::vector<double> velocity;     ///< and to velocities [1/s]
};

/// The weights of a leap.
class LeapWeights {
public:
  /// @param omega  bound of all frequencies [rad/s]; `step`: of the signals' rows [s]
  LeapWeights(double omega, double step, long steps);

  /// Of the run that starts with the displacements of the leap and no velocities.
  StateWeights of_displacement() const;
  /// Of the run that starts with the velocities over omega as displacements, without loads.
  StateWeights of_velocity() const;
  /// Of runs from rest with a unit step of one signal each. Within a step, a signal is the
  /// polynomial through its five points.
  /// @param rows  signal_parts for each step, and a last one: `width` numbers each
  /// @param chosen  columns of `rows`
  std::vector<StateWeights> of_signals(std::span<const double> rows, std::size_t width,
                                       std::span<const std::size_t> chosen) const;
  /// States of a run; the first is its start.
  std::size_t states() const { return states_; }

private:
  StateWeights sums(double omega_time) const;

  double omega_, step_;
  long steps_;
  std::size_t orders_; ///< of Bessel functions
  std::size_t states_;
};

} // namespace dss
