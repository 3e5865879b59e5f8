#pragma once
/// Dynamic relaxation with kinetic damping: a state of rest found by any explicit variant.
///
/// The body is let go under constant loads. Whenever its kinetic energy has passed a peak, velocities are set to zero at the peak: near it
/// most of the motion goes through its equilibrium. What is left then moves again, less far (P. A. Cundall 1976; M. R. Barnes, Int. J. Space Structures 14
/// (1999) 89-104). Masses have no say in the result: scaled ones make all degrees of freedom of an element equally fast.
#include "solver/model/model.hpp"
#include "solver/model/problem.hpp"
#include "variants/api.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace dss {

struct RelaxationSettings {
  double tolerance = 1e-10; ///< unbalanced forces at a peak against the loads
  long most_steps = 2'000'000;
  double dt = 0; ///< [s]
};

struct Relaxation {
  std::vector<double> state;
  bool is_finite = true;
  bool is_settled = false; ///< to the tolerance, or as far as rounding lets it
  std::string reason;      ///< where it is not, or stopped before the tolerance: one line
  long steps = 0, peaks = 0;
  double residual = 0; ///< as the variant's own forces say, at the last peak
};

/// The problem held still (solver/statics) without dampers. With `scaled` masses: inertia in proportion to the largest stiffness that links
/// and ties give a degree of freedom of the body, and no mass above the scene's own.
Problem relaxed_problem(const Problem& problem, bool has_scaled_masses, double loads = 1);

/// @param problem    of the executor, made by relaxed_problem  @param method  of the executor
/// @param load_norm  that of StaticSystem [N]
/// @param precision  of the executor: how far rounding may keep the residual
Relaxation relax(Executor& executor, const Problem& problem, const Method& method, Precision precision,
                 double load_norm, const RelaxationSettings& settings);

} // namespace dss
