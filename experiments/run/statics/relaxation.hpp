#pragma once
/// Dynamic relaxation with kinetic damping: finds a static equilibrium with any explicit variant.
/// The body is released under constant loads. Each time its kinetic energy has passed a peak, the
/// velocities are set to zero at the peak, because most of the motion is then near its equilibrium.
/// The rest of the motion continues with a smaller amplitude. Source: P. A. Cundall 1976; M. R.
/// Barnes, Int. J. Space Structures 14 (1999) 89-104.
/// Masses do not change the result. Scaled masses make all degrees of freedom of an element equally
/// fast.
#include "kernels/model.hpp"
#include "solver/model/problem.hpp"
#include "variants/api/api.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace dss {

/// Limits of a relaxation.
struct RelaxationSettings {
  double tolerance = 1e-10; ///< unbalanced forces at a peak, relative to the loads
  long most_steps = 2'000'000;
  double dt = 0; ///< [s]
};

/// Result of a relaxation. `state` has 13 numbers per element.
struct Relaxation {
  std::vector<double> state;
  bool is_finite = true;
  bool is_settled = false; ///< residual is within the tolerance, or as small as rounding allows
  std::string reason; ///< One line: why it is not settled, or why it stopped above the tolerance.
  long steps = 0, peaks = 0;
  double residual = 0; ///< at the last peak, from the variant's own forces
};

/// Makes the problem for relaxation: held still (solver/statics) and without dampers.
/// @param has_scaled_masses  true: the inertia of each body becomes proportional to the largest
/// stiffness that links and ties give its degrees of freedom, and no mass grows
/// @param loads  factor on the loads
Problem relaxed_problem(const Problem& problem, bool has_scaled_masses, double loads = 1);

/// Runs the relaxation.
/// @param problem  problem of the executor, made by relaxed_problem
/// @param method  method of the executor
/// @param precision  precision of the executor; it decides how large a residual rounding may
/// explain
/// @param load_norm  that of StaticSystem [N]
Relaxation relax(Executor& executor, const Problem& problem, const Method& method,
                 Precision precision, double load_norm, const RelaxationSettings& settings);

} // namespace dss
