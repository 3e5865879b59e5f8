#pragma once
/// States of a run at saved times, without timing.
#include "experiments/run/state/saved_times.hpp"
#include "experiments/run/timed/run.hpp"

#include <vector>

namespace dss {

/// Runs a request in this process and returns its state at each saved time, 13 numbers per element.
/// The number of steps follows from the saved times.
/// @throws InputError as run_scene, and for a step that does not divide the time between saved
/// times
/// @throws UnstableError if the state becomes non-finite
std::vector<std::vector<double>> run_states(RunRequest request, const SavedTimes& times);

} // namespace dss
