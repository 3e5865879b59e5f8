#pragma once
/// Natural frequencies of a Timoshenko cantilever.
#include <vector>

namespace dss {

/// A uniform beam: bending stiffness E I [N m^2], shear stiffness k G A [N], mass per length
/// [kg/m], rotary inertia per length [kg m], length [m].
struct TimoshenkoBeam {
  double bending = 0, shear = 0, mass = 0, rotary = 0, length = 0;
};

/// The `count` smallest natural frequencies [rad/s] of a beam that is clamped at one end. Only
/// frequencies below the beam's cut-off, where shear waves begin, are found. Source: T. C. Huang,
/// J. Appl. Mech. 28 (1961) 579-584.
/// @throws InputError if there are fewer below the cut-off
std::vector<double> cantilever_frequencies(const TimoshenkoBeam& beam, int count);

} // namespace dss
