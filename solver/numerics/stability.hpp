#pragma once
/// Largest stable step of a method on a problem, predicted from the equations of motion linearised at rest.
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"

#include <string>

namespace dss {

/// Prediction of stable_step.
struct StabilityLimit {
  double dt = 0; ///< largest stable step [s]; infinite where nothing vibrates or is damped, and of implicit methods
  double omega_max = 0; ///< largest natural frequency, or an upper bound of it [rad/s]
  double damping = 0;   ///< largest eigenvalue of the damping against the inertia, or an upper bound of it [1/s]
  std::string how;      ///< one line: the way it was found and how sharp it is
};

/// Problems of up to this many elements get a sharp figure when it is asked for.
constexpr std::size_t sharp_stability_elements = 20'000;

/// Step limit of a method on a problem, linearised at rest, with its clamps, extra links, damping and stabilization.
/// Without `sharp`: a rigorous lower bound that costs one pass over the links; on the shapes of the tests it is 0.7 to
/// 1.0 of the sharp figure. With `sharp`: the largest eigenvalues by a Krylov iteration (power iteration's subspace),
/// to about 1e-4. Both take the worst pairing of frequency and damping within these bounds, which no mode may have.
/// Gyroscopic terms and what large rotations change are not in it.
/// @throws InputError for constants whose ratios leave the range of numbers
StabilityLimit stable_step(const Problem& problem, const Method& method, bool sharp = false);

/// Step limit [s] of a method on the single mode x'' + rate x' + omega^2 x = 0; omega [rad/s] and rate [1/s] are not
/// negative. With damping ratio zeta, rate = 2 zeta omega. Infinite for omega = rate = 0. The limit is the first step,
/// upwards from 0, at which the spectral radius of one step exceeds 1 + 1e-12.
double mode_step_limit(const Method& method, double omega, double rate);

} // namespace dss
