#pragma once
/// The results of an ensemble, and its record.
#include "experiments/run/ensemble/members_file.hpp"
#include "experiments/run/plan/run_request.hpp"
#include "experiments/run/timed/run_result.hpp"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

namespace dss {

/// The result of one member, as of a run of its own. Its times and messages are those of the
/// whole ensemble.
struct MemberResult {
  MemberSet member;
  RunResult result;
};

/// The results of an ensemble.
struct EnsembleResult {
  /// The ensemble as one run: elements and links of all members, the digest of the states of all
  /// that did not fail, batch by batch. Not "ok" if a member is not; the reason names such members.
  /// What is not the same for all members is left out.
  RunResult whole;
  std::vector<MemberResult> members;
  std::size_t batches = 0; ///< executors; each computes one member or several
  int lanes = 1;           ///< members of a batch, at most
};

/// Adds a member's result to that of the whole: its elements' steps, its files and the largest of
/// its errors. What is not the same for all members is left out.
void add_member(const RunResult& member, RunResult& whole);

/// The record of an ensemble: that of `whole`, then "ensemble" with a record of each member.
nlohmann::ordered_json ensemble_json(const RunRequest& request, const EnsembleResult& result);

} // namespace dss
