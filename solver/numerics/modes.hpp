#pragma once
/// Exact step limits of small problems: all eigenvalues of the equations linearised at rest, dense.
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace dss {

/// A motion x'' + rate x' + omega^2 x = 0 of a problem, damped at the ratio rate / (2 omega).
struct Mode {
  double omega = 0,
         rate = 0;         ///< [rad/s], [1/s]; of an eigenvector x of the damped problem x* K x and x* C x over x* M x
  std::size_t element = 0; ///< where most of its kinetic energy is
  int dof = 0;             ///< 0 .. 5: ux uy uz rx ry rz
};

/// Step limit with the mode that sets it.
struct ExactLimit {
  double dt = std::numeric_limits<double>::infinity(); ///< [s]
  Mode mode;
  std::size_t unknowns = 0; ///< free degrees of freedom that a link or a tie moves
};

/// Largest pieces of a problem (degrees of freedom that depend on one another) whose dense eigenproblem is solved: a
/// symmetric one, or one of twice the size without symmetry. Both cost some seconds.
constexpr std::size_t most_symmetric_unknowns = 900, most_damped_unknowns = 700;

/// The modes of a problem linearised at rest, and the step limits that they set.
///
/// Runge-Kutta methods: |R(h lambda)| <= 1 for every eigenvalue lambda of the first-order form, of single modes where
/// stiffness and damping commute (as without damping), of the whole matrix else.
///
/// Leapfrog and symplectic Euler are stable on a mode exactly if (h omega / I)^2 + h rate / R <= 1, I and R being their
/// limits on the two axes (mode_step_limit says the same: tested). An eigenvector x of their step matrix, whatever the
/// damping, obeys the recurrence of the mode with omega^2 = x* K x and rate = x* C x, so all are stable if the largest
/// eigenvalue of (h/I)^2 K + (h/R) C is at most 1; and if it exceeds 1, its eigenvector flips its sign and grows.
class Modes {
public:
  explicit Modes(const Problem& problem);
  ~Modes();
  /// Largest stable step of an explicit method. Nothing if the problem is too large. What the methods of a family share
  /// is found once.
  std::optional<ExactLimit> step_limit(const Method& method);

private:
  struct Piece;
  double rate_ = 0; ///< one over the unit of time in the pieces [1/s]
  std::vector<Piece> pieces_;
};

} // namespace dss
