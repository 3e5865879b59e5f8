#pragma once
/// Members of an ensemble that one executor computes: a member a lane of its packs.
#include "experiments/run/checkpoint/checkpoint.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "variants/api/api.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// Where a member stands.
struct MemberStanding {
  /// How a member ended before its time.
  struct Failure {
    long steps; ///< with the one that failed
    std::string reason;
  };
  long step = 0;
  std::optional<Failure> failure;
  HistoryRows history;
  std::vector<double> kept; ///< numbers of its elements (kept_state.hpp); empty if it failed
  /// Of a member that has done all of its steps: the state, since a leapfrog cannot give its
  /// velocities at the end anew (StateTransfer::restore). Else empty
  std::vector<double> end;
};

/// Members that advance together. Lanes without a member compute the first one once more.
class MemberBatch {
public:
  /// @param members  at least one and at most `lanes`; alike in the sense of group_members; they
  ///     outlive this object
  /// @param lanes    members that the executor computes; 1: an executor of a problem alone
  MemberBatch(std::vector<const RunPlan*> members, int lanes, const Setup& setup);

  std::size_t size() const { return members_.size(); }
  /// Writes the initial state of all members.
  void restart();
  /// Computes the signals of the next steps.
  void prepare(long steps);
  /// Advances all members that are alive by the steps of the last prepare().
  void advance();
  long step() const { return step_; }
  /// Where a member failed: the step counts from the start. Empty while it is alive.
  const std::optional<Outcome>& failure(std::size_t member) const { return failures_[member]; }
  /// Ends a member whose state nobody can use.
  void fail(std::size_t member) { failures_[member] = Outcome{false, step_ - 1}; }
  bool is_alive() const;
  bool is_done() const { return step_ >= members_.front()->steps; }
  /// Reads the present state of all members. Collective; state() does so too if it must.
  void read();
  /// The present state of a member, 13 numbers an element. It is valid until the next advance().
  std::span<const double> state(std::size_t member);
  /// What each member keeps, as in MemberStanding. Collective.
  std::vector<std::vector<double>> save();
  using Standings = std::span<const MemberStanding* const>;
  /// Puts all members where they stood. Collective.
  /// @throws InputError if they stood at different steps, beyond their end, or at an end that was
  ///     none
  void restore(Standings members);
  Executor& executor() { return *executor_; }

private:
  const RunPlan& plan_of_lane(std::size_t lane) const {
    return *members_[lane < members_.size() ? lane : 0];
  }
  std::size_t lanes() const { return ensemble_ ? ensemble_->size() : 1; }
  std::size_t elements() const { return members_.front()->scene.problem.lattice.element_count; }
  /// @return a member that has not failed, or null
  const MemberStanding* require_one_step(Standings members) const;
  /// Calls visit(first, numbers) for pieces of what the executor keeps; `width` numbers an element.
  template <class Visit>
  void each_piece(std::size_t width, Visit&& visit);

  std::vector<const RunPlan*> members_;
  std::optional<Ensemble> ensemble_;
  std::unique_ptr<Executor> executor_;
  long step_ = 0, next_steps_ = 0;
  std::vector<double> signals_; ///< of the next steps
  std::vector<std::optional<Outcome>> failures_;
  std::vector<std::vector<double>> states_; ///< of each member; empty: not read since the last step
  std::vector<std::vector<double>> kept_;   ///< of members that were restored at their end
};

/// Members that one executor computes.
struct BatchPlan {
  std::vector<std::size_t> members; ///< their indices
  bool has_lanes;                   ///< false: one member, as a run of its own
};

/// Groups members that one executor can compute: of equal model, method, steps, terms and loads.
/// @param lanes  members that one executor computes on all ranks; 1: each member is divided
/// @return batches of at most `lanes` members
std::vector<BatchPlan> group_members(std::span<const RunPlan> members, int lanes, int ranks);

} // namespace dss
