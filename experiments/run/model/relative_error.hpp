#pragma once
/// Error of a model of small rotations as one relative number.
#include "experiments/run/state/state_access.hpp"
#include "solver/model/sufficiency/model_error.hpp"

namespace dss {

/// Largest ratio of an error to the scale of its kind (error_scales); infinite if the scale is
/// zero.
double relative_error(const Problem& problem, const KindBounds& errors, const KindValues& largest);

} // namespace dss
