#pragma once
/// Largest stable step of an explicit method on a problem, predicted from the equations of motion linearised at rest.
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"
#include "solver/numerics/modes.hpp"
#include "solver/numerics/step_growth.hpp"

#include <span>
#include <string>
#include <vector>

namespace dss {

/// Prediction of stable_step.
struct StabilityLimit {
  double dt = 0;        ///< largest stable step [s]; infinite where nothing vibrates or is damped, 0 where a mode grows
                        ///< however small the step
  double omega_max = 0; ///< largest natural frequency, or an upper bound of it [rad/s]
  double damping = 0;   ///< largest eigenvalue of the damping against the inertia, or an upper bound of it [1/s]
  std::string how;      ///< one line: the way it was found and how sharp it is
  bool is_exact = false; ///< to rounding, for motion about the state of rest
  Mode mode;             ///< that sets the limit; where it is not exact, the worst that could be there, of no element
};

/// Problems of up to this many elements get a sharp figure when it is asked for.
constexpr std::size_t sharp_stability_elements = 20'000;

/// Step limit of a method on a problem, linearised at rest, with its clamps, extra links, damping and stabilization.
/// Without `sharp`: a rigorous lower bound that costs one pass over the links; on the shapes of the tests it is 0.7 to
/// 1.0 of the sharp figure. With `sharp`: exact for small problems (modes.hpp says which); for larger ones the largest
/// eigenvalues by a Krylov iteration (power iteration's subspace), to about 1e-4, and the worst pairing of frequency and
/// damping within them, which no mode may have. Gyroscopic terms and what large rotations change are not in it.
/// @throws InputError for constants whose ratios leave the range of numbers
StabilityLimit stable_step(const Problem& problem, const Method& method, bool sharp = false);

/// The sharp figures of several methods; the problem's modes are found once.
std::vector<StabilityLimit> stable_steps(const Problem& problem, std::span<const Method* const> methods);

/// The method as it is run with a step dt [s]: rkc2 with the fewest stages that its limit on the problem asks for, every other
/// method as it is. Where no number of stages up to 200 suffices, that which its damping asks for, at most 200: stable_step then says no.
Method fitted(const Problem& problem, const Method& method, double dt);

} // namespace dss
