#pragma once
/// What one member of an ensemble makes of its states on the way: looks at its energy, checks,
/// files, its result.
#include "experiments/run/ensemble/member_batch.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/timed/history.hpp"
#include "experiments/run/timed/oracle_check.hpp"
#include "experiments/run/timed/output.hpp"
#include "experiments/run/timed/run_result.hpp"
#include "experiments/run/timed/verdict.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace dss {

/// One member. A failure of any kind becomes its status, and removes its files.
class MemberRun {
public:
  /// @param plan, request  of the member; they outlive this object
  MemberRun(const RunPlan& plan, const RunRequest& request);
  bool is_ok() const { return result_.status == "ok"; }
  const RunResult& result() const { return result_; }
  const OracleCheck& oracle_check() const { return oracle_check_; }
  /// True if the energy of the member is followed.
  bool has_balance() const { return has_energy_balance(plan_, request_, equations()); }
  /// Takes the state after `step` steps, for everything that wants it. Called at step 0, at all
  /// stops and at the end.
  void look(std::span<const double> state, long step);
  /// Frames that are written stay if a later one cannot be written: the ensemble is saved.
  void keep_frames() { series_.keep_finished(); }
  std::string history_columns() const { return history_ ? history_->columns() : ""; }
  HistoryRows history() const { return history_ ? history_->kept() : HistoryRows{}; }
  /// Goes on where an earlier run stood, in which the member may have failed.
  void resume(const MemberStanding& standing);
  /// The member became unstable; steps count from the start.
  void fail(const Outcome& failure);
  /// Takes the final state.
  void end(std::span<const double> state);
  /// Begins a second run whose every step is looked at: for the whole balance of the energy.
  void begin_steps();
  void look_at_step(std::span<const double> state, long step);
  /// Judges check and energy, after all runs.
  /// @param last  the final state of the last run, whose bits must be those of the first
  void judge(std::span<const double> last);
  void discard_files() { series_.discard(); }

private:
  Rotation equations() const { return equations_of(plan_, plan_.model); }
  std::uint64_t digest_of(std::span<const double> state) const;
  /// Makes an UnstableError of the member its status.
  void guarded(const std::function<void()>& act);

  const RunPlan& plan_;
  const RunRequest& request_;
  RunResult result_;
  FileSet outputs_; ///< of this member
  FrameSeries series_;
  std::optional<RunHistory> history_; ///< of the root
  OracleCheck oracle_check_;
  std::optional<EnergyBalance> balance_;
};

} // namespace dss
