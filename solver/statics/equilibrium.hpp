#pragma once
/// States of rest under loads, by one linear solution or by Newton's iteration.
#include "solver/statics/sparse_solver.hpp"
#include "solver/statics/static_system.hpp"

#include <string>

namespace dss {

/// How to find an equilibrium.
struct EquilibriumOptions {
  SolverKind solver = SolverKind::automatic;
  Preconditioner preconditioner = Preconditioner::incomplete_cholesky;
  /// Largest allowed last correction, over the largest displacement; or the smallest that rounding
  /// allows.
  double tolerance = 1e-12;
  /// Refuses a state that is not a minimum of the energy, if the solver can tell.
  bool must_be_stable = true;
};

/// An equilibrium, and the work to find it.
struct Equilibrium {
  StaticSystem::State state;
  bool is_found = false;
  std::string reason;     ///< if none was found: one line
  std::string note;       ///< remark for the user on a state that was found
  std::string solver;     ///< solver of the linear equations
  int iterations = 0;     ///< corrections of the state
  int matrices = 0;       ///< matrices that were factorised or got a preconditioner
  long cg_iterations = 0; ///< iterations of conjugate gradients in all solutions
  int increments = 0;     ///< increments of the loads
  double correction = 0;  ///< last correction over the largest displacement
  double residual = 0;    ///< unbalanced forces over the loads
};

/// Finds a state without unbalanced forces under the loads at the end of the problem's run.
///
/// Linear equations take one solution, then further solutions for the forces that it leaves
/// (iterative refinement in long double). Other equations take Newton's method. It renews its
/// matrix only if corrections fall by less than a factor of ten. If they do not fall, loads grow in
/// steps. A mechanism (a motion that no link resists) is an error of the direct solver. `automatic`
/// then uses conjugate gradients, which do not move the mechanism if no load drives it.
/// @param start  first state; default: rest
/// @throws InputError if there is no single answer: a body that is free to move, a mechanism
/// @throws UnstableError if the equilibrium is not stable (buckled)
Equilibrium find_equilibrium(StaticSystem& system, const EquilibriumOptions& options = {},
                             const StaticSystem::State& start = {});

} // namespace dss
