#pragma once
/// Natural frequencies of Timoshenko's cantilever.
#include <vector>

namespace dss {

/// A uniform beam: bending stiffness E I [N m^2], shear stiffness k G A [N], mass and rotary inertia a length [kg/m], [kg m], length [m].
struct TimoshenkoBeam {
  double bending = 0, shear = 0, mass = 0, rotary = 0, length = 0;
};

/// The `count` smallest natural frequencies of the beam clamped at one end [rad/s], from the frequency equation of T. C. Huang (J. Appl. Mech. 28
/// (1961) 579-584), below the beam's cut-off, where waves of shear begin.
/// @throws InputError if fewer are below it
std::vector<double> cantilever_frequencies(const TimoshenkoBeam& beam, int count);

} // namespace dss
