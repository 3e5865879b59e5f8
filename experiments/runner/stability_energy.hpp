#pragma once
/// What a method takes from the energy of an undamped mode, or gives to it, in each step: stable is not accurate.
#include "variants/api.hpp"

#include <vector>

namespace dss {

struct EnergyPoint {
  double h_omega = 0;
  double theory = 0;   ///< change of energy a step over the energy: spectral radius squared, less 1
  double measured = 0; ///< the same of a run
  long steps = 0;      ///< of the run
  bool is_as_predicted() const;
};

/// A run of the problem's only mode, undamped and of frequency omega [rad/s], from its initial state. For each of two
/// successive windows the largest energy counts, so that what only goes to and fro, as in symplectic methods, cancels.
EnergyPoint energy_change(const Plugin& plugin, const Problem& problem, const Method& method, double omega,
                          double h_omega);

/// h omega at which to look: `points` evenly up to a fifth beyond the method's limit (of a method without one: up to 2),
/// and 2.4495 = sqrt 6, where RK4 takes most.
std::vector<double> energy_range(const Method& method, int points);

} // namespace dss
