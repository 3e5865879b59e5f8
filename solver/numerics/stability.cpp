#include "solver/numerics/stability.hpp"

#include "solver/error.hpp"
#include "solver/numerics/faber.hpp"
#include "solver/numerics/spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dss {
namespace {

/// Smallest limit over every mode with omega <= omega_max and least_damping omega^2 <= rate <=
/// damping. Every eigenvalue of the problem belongs to a mode of that region: omega^2 = x* K x and
/// rate = x* C x of its eigenvector are in it. Along a ray of constant damping ratio the limit
/// falls as 1 / omega. So the worst mode lies on an outer edge of the region: the curve of least
/// damping, omega = omega_max, or rate = damping.
/// @param enough  a limit above this [s] may be returned as infinite
ExactLimit worst_pairing(const Method& method, const Spectrum& spectrum, double enough) {
  constexpr int points = 64;
  ExactLimit worst;
  const auto consider = [&](double omega, double rate) {
    if (const double dt = mode_step_limit(method, omega, rate, std::min(worst.dt, enough));
        dt < worst.dt)
      worst = {dt, {omega, rate}};
  };
  // The bounds need not belong to one mode: the least damping at the largest frequency may exceed
  // the largest damping.
  const double omega_max = spectrum.omega_max, most = spectrum.damping;
  const auto least = [&](double omega) {
    return std::min(most, spectrum.least_damping * omega * omega);
  };
  // The fastest and most damped mode comes first: its limit makes the search for the others short.
  for (int n = points; n >= 0; --n) {
    const double part = double(n) / points;
    consider(part * omega_max, least(part * omega_max));
    consider(omega_max, least(omega_max) + part * (most - least(omega_max)));
    consider(part * omega_max, most);
  }
  return worst;
}

StabilityLimit limit_within(const Method& method, const Spectrum& spectrum, std::string how,
                            double enough = std::numeric_limits<double>::infinity()) {
  const ExactLimit worst = worst_pairing(method, spectrum, enough);
  return {worst.dt, spectrum.omega_max, spectrum.damping, std::move(how), false, worst.mode};
}

/// The same limit, with an explanation if it is 0.
StabilityLimit explained(StabilityLimit limit) {
  if (limit.dt == 0) limit.how += "; undamped modes grow however small the step";
  return limit;
}

/// The bound of the problem's spectrum.
/// @throws InputError if it is not finite
Spectrum finite_bound(const Problem& problem) {
  const Spectrum bound = spectrum_bound(problem);
  if (!std::isfinite(bound.omega_max + bound.damping))
    throw InputError(fmt::format(
        "{}: no stability limit can be found: stiffness over mass or inertia is beyond the range "
        "of numbers; give constants in SI units",
        problem.name));
  return bound;
}

bool is_large(const Problem& problem) {
  return problem.lattice.element_count > sharp_stability_elements;
}

Method fitted_faber(const Problem& problem, double dt) {
  const Spectrum spectrum = found_spectrum(problem);
  Method method = faber(spectrum, dt);
  if (method.stages > 0) return method;
  constexpr double shorter = 1.25;
  double least = dt / shorter;
  while (faber(spectrum, least).stages == 0 && least > 0) least /= shorter;
  throw InputError(
      fmt::format("{}: a step of {:g} s would take more than {} stages of {}, or round "
                  "too much; give --dt {:.2g} or less",
                  problem.name, dt, most_faber_stages, method.name, 0.95 * least));
}

} // namespace

Spectrum found_spectrum(const Problem& problem) {
  const Spectrum bound = finite_bound(problem);
  if (is_large(problem)) return bound;
  Spectrum found = krylov_spectrum(problem);
  found.omega_max = std::min(found.omega_max, bound.omega_max);
  found.damping = std::min(found.damping, bound.damping);
  return found;
}

std::vector<StabilityLimit> stable_steps(const Problem& problem,
                                         std::span<const Method* const> methods) {
  const Spectrum found = found_spectrum(problem);
  const std::string how =
      is_large(problem)
          ? fmt::format("bound from single links (more than {} elements: no sharp figure)",
                        sharp_stability_elements)
          : fmt::format("Krylov iteration, {} products", found.products);
  Modes modes(problem);
  std::vector<StabilityLimit> limits;
  for (const Method* method : methods)
    if (const auto exact = modes.step_limit(*method))
      limits.push_back(
          explained({exact->dt, found.omega_max, found.damping,
                     fmt::format("exact: all modes of {} degrees of freedom", exact->unknowns),
                     true, exact->mode}));
    else
      limits.push_back(explained(limit_within(*method, found, how)));
  return limits;
}

StabilityLimit stable_step(const Problem& problem, const Method& method, bool sharp) {
  if (!sharp)
    return explained(limit_within(method, finite_bound(problem), "bound from single links"));
  const Method* const one = &method;
  return stable_steps(problem, {&one, 1})[0];
}

Method fitted(const Problem& problem, const Method& method, double dt) {
  if (!method.is_fitted()) return method;
  if (method.is_exponential) return fitted_faber(problem, dt);
  constexpr int most_stages = 200, tried = 12;
  const Spectrum bound = finite_bound(problem);
  if (const Method longest = rkc2(most_stages); longest.real_limit < dt * bound.damping)
    return longest;
  int least = 2;
  while (least < most_stages && rkc2(least).real_limit < dt * bound.damping) ++least;
  std::vector<Method> candidates;
  std::vector<const Method*> pointers;
  for (int stages = least; stages < least + tried && stages <= most_stages; ++stages)
    candidates.push_back(rkc2(stages));
  for (const Method& candidate : candidates) {
    if (limit_within(candidate, bound, "", dt).dt >= dt) return candidate;
    pointers.push_back(&candidate);
  }
  const std::vector<StabilityLimit> limits = stable_steps(problem, pointers);
  for (std::size_t n = 0; n < limits.size(); ++n)
    if (limits[n].dt >= dt) return candidates[n];
  return candidates.front();
}

} // namespace dss
