#pragma once
/// What runs and ensembles that are saved do at a pause between steps.
#include "experiments/base/interrupt.hpp"
#include "variants/api/executor.hpp"

#include <string>

namespace dss {

/// Steps to the next pause: less than a second of work, so that a signal is seen.
/// @param elements  that one thread of the run computes, or all of it
long steps_of_pause(double elements);

enum class Saving { none, save, save_and_end };

/// What all ranks do: the clock of the root decides whether a checkpoint is due, and a signal at
/// any rank ends all. Collective.
Saving common_saving(Executor& executor, bool is_due, bool is_asked);

/// Ends a run that a signal ends. All ranks meet there, after the root has written.
/// @param failure  why it could not be saved, or empty
[[noreturn]] void end_saved(const InterruptsDeferred& interrupts, const std::string& failure,
                            long step, const std::string& checkpoint);

} // namespace dss
