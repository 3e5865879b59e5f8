#pragma once
/// What `dssbench run` prints of a run.
#include "experiments/run/ensemble/ensemble_run.hpp"
#include "experiments/run/timed/run_result.hpp"

namespace dss {

/// Prints a result to the standard output, some ten lines.
void print_summary(const RunResult& result);

/// A line about what clamps exert.
std::string reactions_text(const Reactions& reactions);

/// Prints the ensemble as a whole, then a line for each member.
void print_ensemble(const EnsembleResult& result);

} // namespace dss
