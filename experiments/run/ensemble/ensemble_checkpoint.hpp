#pragma once
/// Checkpoints of an ensemble (../checkpoint/README.md). They hold each member by itself, so that
/// another number of lanes, threads or ranks may go on.
#include "experiments/base/interrupt.hpp"
#include "experiments/run/checkpoint/checkpoint.hpp"
#include "experiments/run/checkpoint/checkpoint_plan.hpp"
#include "experiments/run/ensemble/ensemble_plan.hpp"
#include "experiments/run/ensemble/member_run.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dss {

using Batches = std::span<const std::unique_ptr<MemberBatch>>;
using MemberRuns = std::span<const std::unique_ptr<MemberRun>>;

/// The ensemble that a checkpoint belongs to: what must agree of all members.
RunIdentity identity_of(const EnsemblePlan& plan, bool has_fma, int kept_fields);

/// Writes where all members stand. Collective: all ranks give their elements, the root writes.
/// @return one line if it could not be written; an earlier checkpoint then stands. Else empty
std::string write_ensemble(const std::string& path, const RunIdentity& identity,
                           const EnsemblePlan& plan, Batches batches, MemberRuns members,
                           bool is_root);

/// Saves an ensemble while it computes: at pauses at which all batches have done the same steps.
class EnsembleSaving {
public:
  /// @param step  that the ensemble begins at
  EnsembleSaving(const RunRequest& request, const EnsemblePlan& plan, const RunIdentity& identity,
                 Batches batches, MemberRuns members, long step);
  /// The step of the next pause after `step`, at most `latest`.
  long next_pause(long step, long latest) const {
    return step + clock_.steps_left(step, latest - step);
  }
  /// Saves all members if that is due, and ends the program if a signal asked. Collective.
  void save_or_end(long step);
  /// Saves the end. A longer run may go on from there.
  void save_end(long step);

private:
  std::string save(long step);
  void note(const std::string& failure) const;

  const RunRequest& request_;
  const EnsemblePlan& plan_;
  const RunIdentity& identity_;
  Batches batches_;
  MemberRuns members_;
  CheckpointClock clock_;
  InterruptsDeferred interrupts_;
};

/// Reads where each member stands.
/// @throws InputError if the file is of another run or is damaged
std::vector<MemberStanding> read_ensemble(const std::string& path, const RunIdentity& identity,
                                          const EnsemblePlan& plan);

} // namespace dss
