#pragma once
/// `dssbench advise`: finds the cheapest way to run a scene within a tolerance, by short trials.
#include "experiments/run/advise/advice.hpp"

#include <functional>
#include <string>

namespace dss {

/// Runs all trials.
/// @param times  saved times at which errors are measured
/// @param note  receives a line of text for each trial; may be empty
/// @throws InputError for a tolerance that is not positive, or a variant that cannot run
/// @throws UnstableError if no step is stable
Advice advise(const Problem& problem, const SavedTimes& times, const AdviseRequest& request,
              const std::function<void(const std::string&)>& note = {});

} // namespace dss
