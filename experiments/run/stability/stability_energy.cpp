#include "experiments/run/stability/stability_energy.hpp"
#include "experiments/run/state/state_access.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/step_growth.hpp"
#include "solver/reference/dynamics.hpp"
#include "variants/leaps/leap_executor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dss {
namespace {

/// Steps of a window: enough to distinguish the change from rounding, and few enough to keep the
/// energy finite.
long window_steps(const Method& method, double log_change) {
  constexpr double furthest = 200; // exponent of e; a double allows about 700
  constexpr long least = 8, of_growth = 64, of_oscillation = 4096;
  const long wanted = method.keeps_energy_bounded ? of_oscillation : of_growth;
  const double bearable = log_change == 0 ? double(wanted) : furthest / std::abs(log_change);
  return std::clamp(long(bearable), least, wanted);
}

} // namespace

bool EnergyPoint::is_as_predicted() const {
  // If the energy oscillates, the measurement is accurate to about the oscillation divided by the
  // steps. Rounding adds an error in each step.
  const double floor = steps > 1000 ? 1e-4 : 1e-13;
  return std::abs(measured - theory) <= floor + 0.01 * std::abs(theory);
}

EnergyPoint energy_change(const Plugin& plugin, const Problem& problem, const Method& method,
                          double omega, double h_omega) {
  const double dt = h_omega / omega, radius = spectral_radius(method, dt, omega, 0);
  EnergyPoint point{h_omega, radius * radius - 1};
  // both eigenvalues are on the unit circle
  if (method.keeps_energy_bounded && std::abs(point.theory) < 1e-6) point.theory = 0;
  const long window = window_steps(method, 2 * std::log(radius));
  const auto executor =
      make_executor(plugin, {problem, method, Model::spatial, Precision::f64, dt});
  write_initial_state(*executor, problem);
  const std::vector<double> no_signals((std::size_t(method.stages) + 1) * signal_count(problem),
                                       0.0);
  reference::Dynamics<double> dynamics(problem);
  std::array<double, 2> most = {0, 0};
  for (long step = 0; step < 2 * window; ++step) {
    double& of_window = most[step < window ? 0 : 1];
    of_window =
        std::max(of_window, dynamics.energy(whole_state(*executor, problem.lattice.element_count)));
    executor->advance(1, no_signals);
  }
  point.measured = std::expm1(std::log(most[1] / most[0]) / double(window));
  point.steps = 2 * window;
  return point;
}

std::vector<double> energy_range(const Method& method, int points) {
  const double end = 1.2 * (method.imaginary_limit > 0 ? method.imaginary_limit : 2 / 1.2);
  std::vector<double> range = {std::sqrt(6.0)};
  for (int n = 1; n <= points; ++n) range.push_back(end * n / points);
  if (range.front() > end) range.erase(range.begin());
  // Exactly at its limit, a symplectic method has a double eigenvalue, and motion grows in
  // proportion to time.
  std::erase_if(range, [&](double h) { return std::abs(h - method.imaginary_limit) < 1e-6; });
  std::sort(range.begin(), range.end());
  return range;
}

} // namespace dss
