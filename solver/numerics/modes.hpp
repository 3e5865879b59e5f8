#pragma once
/// Exact step limits of small problems, from all eigenvalues of the equations linearised at rest
/// (dense).
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace dss {

/// A motion x'' + rate x' + omega^2 x = 0 of a problem. Its damping ratio is rate / (2 omega).
struct Mode {
  /// [rad/s], [1/s]. For an eigenvector x of the damped problem: omega^2 = x* K x / x* M x and rate
  /// = x* C x / x* M x.
  double omega = 0, rate = 0;
  std::size_t element = 0; ///< element with most of the kinetic energy
  int dof = 0;             ///< 0 .. 5: ux uy uz rx ry rz
};

/// A step limit, and the mode that sets it.
struct ExactLimit {
  double dt = std::numeric_limits<double>::infinity(); ///< [s]
  Mode mode;
  std::size_t unknowns = 0; ///< free degrees of freedom that a link or a tie moves
};

/// Size limits for dense eigenproblems of one piece (degrees of freedom that depend on one
/// another): symmetric, or of twice the size without symmetry. Both take some seconds.
constexpr std::size_t most_symmetric_unknowns = 900, most_damped_unknowns = 700;

/// The modes of a problem linearised at rest, and the step limits that they set.
///
/// Runge-Kutta methods: |R(h lambda)| <= 1 for every eigenvalue lambda of the first-order form. If
/// stiffness and damping commute (for example without damping), the eigenvalues are those of single
/// modes; otherwise those of the whole matrix.
///
/// Leapfrog and symplectic Euler are stable on a mode exactly if (h omega / I)^2 + h rate / R <= 1,
/// with their limits I and R on the imaginary and the real axis (a test compares mode_step_limit).
/// An eigenvector x of their step matrix obeys, for any damping, the recurrence of the mode with
/// omega^2 = x* K x and rate = x* C x. So all modes are stable if the largest eigenvalue of (h/I)^2
/// K + (h/R) C is at most 1. If it exceeds 1, its eigenvector flips its sign in every step and
/// grows.
class Modes {
public:
  explicit Modes(const Problem& problem);
  ~Modes();
  /// Largest stable step of an explicit method, or nothing if the problem is too large. Results
  /// that methods of a family share are computed once.
  std::optional<ExactLimit> step_limit(const Method& method);

private:
  struct Piece;
  double rate_ = 0; ///< one over the unit of time in the pieces [1/s]
  std::vector<Piece> pieces_;
};

} // namespace dss
