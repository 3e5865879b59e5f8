#pragma once
/// Largest stable step of an explicit method on a problem, predicted from the equations of motion
/// linearised at rest.
#include "solver/model/problem.hpp"
#include "solver/numerics/method.hpp"
#include "solver/numerics/modes.hpp"
#include "solver/numerics/spectrum.hpp"
#include "solver/numerics/step_growth.hpp"

#include <span>
#include <string>
#include <vector>

namespace dss {

/// Prediction of stable_step.
struct StabilityLimit {
  /// Largest stable step [s]. Infinite if nothing vibrates or is damped; 0 if a mode grows at every
  /// step size.
  double dt = 0;
  double omega_max = 0; ///< largest natural frequency, or an upper bound of it [rad/s]
  /// Largest eigenvalue of damping against inertia, or an upper bound of it [1/s].
  double damping = 0;
  std::string how;       ///< one line: how it was found and how sharp it is
  bool is_exact = false; ///< to rounding, for motion about the state of rest
  /// Mode that sets the limit. If the limit is not exact: the worst mode that could exist, without
  /// an element.
  Mode mode;
};

/// Problems of at most this many elements get a sharp limit on request.
constexpr std::size_t sharp_stability_elements = 20'000;

/// Step limit of a method on a problem, linearised at rest, with its clamps, extra links, damping
/// and stabilization. Gyroscopic terms and effects of large rotations are not included.
/// Without `sharp`: a rigorous lower bound that costs one pass over the links (README.md compares
/// it with the sharp limit).
/// With `sharp`: exact for small problems (modes.hpp says which). For larger ones, the largest
/// eigenvalues by a Krylov iteration, to about 1e-4, with the worst combination of frequency and
/// damping within them; such a mode need not exist.
/// @throws InputError if ratios of constants exceed the range of numbers
StabilityLimit stable_step(const Problem& problem, const Method& method, bool sharp = false);

/// Sharp limits of several methods. The problem's modes are computed once.
std::vector<StabilityLimit> stable_steps(const Problem& problem,
                                         std::span<const Method* const> methods);

/// The spectrum: found by a Krylov iteration for at most sharp_stability_elements, else its bound.
/// @throws InputError as stable_step
Spectrum found_spectrum(const Problem& problem);

/// The method as it is run with a step dt [s]: faber as the step and the problem need it
/// (InputError if it cannot be that long); rkc2 with the fewest stages whose limit on the
/// problem allows dt, every other method unchanged. If no number of stages up to 200 suffices, the
/// number that its damping needs, at most 200; stable_step then refuses the step.
Method fitted(const Problem& problem, const Method& method, double dt);

} // namespace dss
