#pragma once
/// Runs one scene on one variant: the body of `dssbench run`.
#include "experiments/run/plan/run_request.hpp"
#include "experiments/run/timed/run_result.hpp"
#include "solver/io/file_set.hpp"

namespace dss {

/// Runs a request and writes its output files, which the caller commits. (Frames of a series appear
/// at once.) The status of the result is "unstable" after a non-finite state or energy, "wrong"
/// after a failed check or if its energy is wrong (DESIGN.md section 7), "bound" if the run stopped
/// because the model's error may exceed its tolerance, and "faulty" if the guard found other bits.
/// @throws InputError for any mistake in the request, and for numbers beyond their range
/// @throws UnstableError for a step above the predicted limit that is not forced, and for stresses
///     beyond the range of numbers
RunResult run_scene(const RunRequest& request, FileSet& outputs);
/// The same; commits the files.
RunResult run_scene(const RunRequest& request);

} // namespace dss
