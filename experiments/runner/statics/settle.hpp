#pragma once
/// A damped run in time until nothing moves: what a state of rest must be.
#include "experiments/runner/statics/analysis.hpp"

namespace dss {

/// The scene held still, with its own masses and dampers and so much viscous damping to the frame besides that the lowest mode is damped critically, stepped by an
/// explicit variant until the oracle finds unbalanced forces below the tolerance. It starts at rest, unstrained.
AnalysisResult settle(const RunRequest& run, const AnalysisRequest& request);

} // namespace dss
