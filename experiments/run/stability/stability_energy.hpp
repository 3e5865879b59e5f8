#pragma once
/// Energy that a method adds to or removes from an undamped mode in each step. A stable method is
/// not always accurate.
#include "variants/api/api.hpp"

#include <vector>

namespace dss {

/// Predicted and measured change of energy at one step size.
struct EnergyPoint {
  double h_omega = 0;
  double theory = 0;   ///< relative change of energy per step: squared spectral radius minus 1
  double measured = 0; ///< the same, measured in a run
  long steps = 0;      ///< steps of the run
  bool is_as_predicted() const;
};

/// Runs the problem's only mode, which is undamped and has the frequency omega [rad/s], from its
/// initial state. The largest energies of two successive windows are compared, so that a pure
/// oscillation of the energy, as in symplectic methods, cancels.
EnergyPoint energy_change(const Plugin& plugin, const Problem& problem, const Method& method,
                          double omega, double h_omega);

/// Values of h omega to measure: `points` even values up to 1.2 times the method's limit (up to 2
/// for a method without a limit), and 2.4495 = sqrt 6, where RK4 removes most energy.
std::vector<double> energy_range(const Method& method, int points);

} // namespace dss
