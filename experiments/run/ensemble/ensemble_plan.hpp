#pragma once
/// From the request of an ensemble to a plan of each member and to batches.
#include "experiments/run/ensemble/member_batch.hpp"
#include "experiments/run/ensemble/members_file.hpp"
#include "experiments/run/plan/run_plan.hpp"

#include <string>
#include <vector>

namespace dss {

/// An ensemble in which every value is decided.
struct EnsemblePlan {
  std::vector<MemberSet> members;
  std::vector<RunRequest> requests; ///< of each member, as of a run of its own
  std::vector<RunPlan> plans;       ///< of each member
  std::vector<BatchPlan> batches;
  int lanes = 1; ///< members of a batch, at most
};

/// Makes the plan of request.ensemble. @throws InputError, UnstableError as run_ensemble
EnsemblePlan plan_ensemble(const RunRequest& request);

} // namespace dss
