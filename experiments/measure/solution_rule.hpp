#pragma once
/// Reads how a study computes its solution: the result that errors are measured against.
#include "experiments/run/state/saved_times.hpp"
#include "experiments/run/state/solution.hpp"
#include "solver/json/object_node.hpp"

#include <string>

namespace dss {

/// Reads "solution": {"variant", "model", "integrator", "tolerance", "most_steps"}; each key may be
/// absent.
/// @throws InputError with the place
SolutionRule read_solution_rule(ObjectNode& object);

/// Reads `end_time` [s] and `saved_times`. The end time is multiplied by `shorten`, a factor of the
/// scale.
/// @throws InputError with the place
SavedTimes read_saved_times(ObjectNode& object, double shorten);

} // namespace dss
