#pragma once
/// Finds a static equilibrium by a damped run in time, as a check of the other solvers.
#include "experiments/run/statics/analysis.hpp"

namespace dss {

/// Runs the scene held still, with its own masses and dampers. Viscous damping to the frame is
/// added so that the lowest mode is damped critically. An explicit variant steps the scene from
/// unstrained rest until the oracle finds unbalanced forces below the tolerance.
/// @throws InputError if the scene has no mode with a frequency
/// @throws UnstableError if the run becomes non-finite
AnalysisResult settle(const RunRequest& run, const AnalysisRequest& request);

} // namespace dss
