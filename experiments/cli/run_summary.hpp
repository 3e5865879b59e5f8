#pragma once
/// What `dssbench run` prints of a run.
#include "experiments/run/timed/run_result.hpp"

namespace dss {

/// Prints a result to the standard output, some ten lines.
void print_summary(const RunResult& result);

} // namespace dss
