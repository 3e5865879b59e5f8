#pragma once
/// States of a run at saved times, where its time is of no interest.
#include "experiments/runner/precision/saved_times.hpp"
#include "experiments/runner/run.hpp"

#include <vector>

namespace dss {

/// Runs a request, whose number of steps follows from the saved times, in this process: its state at each of them.
/// @throws InputError as run_scene, and for a step that does not divide the time between them; UnstableError if it leaves the finite
/// numbers
std::vector<std::vector<double>> run_states(RunRequest request, const SavedTimes& times);

} // namespace dss
