#pragma once
/// What all ranks of a job did together. All calls are collective; on one process they return what
/// they get.
#include "experiments/base/usage.hpp"
#include "experiments/run/timed/run_result.hpp"
#include "variants/api/api.hpp"

namespace dss {

/// The usage of all ranks during the same work.
Usage of_all_ranks(Executor& executor, Usage own);

/// What was exchanged between two moments.
inline Traffic since(const Traffic& before, Traffic now) {
  return {now.messages - before.messages, now.bytes - before.bytes, now.wait_s - before.wait_s};
}

/// Puts what all ranks sent in the run into its result, which has its time.
/// @param sent   by this rank
/// @param steps  of the executors that sent it
void put_traffic(Executor& executor, const Traffic& sent, double steps, RunResult& result);

} // namespace dss
