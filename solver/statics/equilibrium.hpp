#pragma once
/// States of rest under loads: one linear solution, or Newton's iteration.
#include "solver/statics/sparse_solver.hpp"
#include "solver/statics/static_system.hpp"

#include <string>

namespace dss {

struct EquilibriumOptions {
  SolverKind solver = SolverKind::automatic;
  Preconditioner preconditioner = Preconditioner::incomplete_cholesky;
  double tolerance =
      1e-12; ///< of the last correction, against the largest displacement; or as far as rounding lets it fall
  bool must_be_stable = true; ///< refuses a state that is no minimum of the energy, where the solver can tell
};

struct Equilibrium {
  StaticSystem::State state;
  bool is_found = false;
  std::string reason;     ///< where none was found: one line
  std::string note;       ///< what a user should know of a state that was found
  std::string solver;     ///< of the linear equations
  int iterations = 0;     ///< corrections of the state
  int matrices = 0;       ///< that were factorised, or got a preconditioner
  long cg_iterations = 0; ///< in all of them
  int increments = 0;     ///< of the loads
  double correction = 0;  ///< the last, against the largest displacement
  double residual = 0;    ///< unbalanced forces against the loads
};

/// A state without unbalanced forces under the loads at the end of the problem's run, from a given one (default: rest).
///
/// Linear equations take one solution, and more of the same by what forces it leaves (iterative refinement in long double). Others take
/// Newton's method: its matrix is renewed only where corrections fall by less than a factor of ten, and where they do not fall, loads grow in steps.
/// A mechanism, a motion that no link feels, is an error of the direct solver; `automatic` then takes conjugate gradients, which leave it alone
/// where no load drives it.
/// @throws InputError where no single answer exists: a body that is free to move, a mechanism
/// @throws UnstableError for an equilibrium that is not stable: buckled
Equilibrium find_equilibrium(StaticSystem& system, const EquilibriumOptions& options = {},
                             const StaticSystem::State& start = {});

} // namespace dss
