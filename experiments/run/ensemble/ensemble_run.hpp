#pragma once
/// Runs the members of an ensemble side by side: `dssbench run SCENE --ensemble FILE`.
#include "experiments/run/ensemble/ensemble_record.hpp"

namespace dss {

/// Runs all members of request.ensemble, each with the bits of a run of its own by the same model.
/// A member that becomes unstable ends alone. Writes the output files of each: F.vtu becomes
/// F-NAME.vtu.
/// @throws InputError before anything runs: members whose elements or links differ, what plan_run
///     refuses for a member, and options that ensembles do not take
EnsembleResult run_ensemble(const RunRequest& request);

} // namespace dss
