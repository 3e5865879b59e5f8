#pragma once
/// A run on an executor, from the initial state to the end. It pauses at the steps where the state
/// is inspected. Only advance() is timed.
#include "experiments/base/interrupt.hpp"
#include "experiments/base/progress.hpp"
#include "experiments/run/checkpoint/checkpoint.hpp"
#include "experiments/run/checkpoint/checkpoint_plan.hpp"
#include "experiments/run/guard/flipped_bit.hpp"
#include "experiments/run/guard/guard.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/timed/adaptive_steps.hpp"
#include "experiments/run/timed/history.hpp"
#include "experiments/run/timed/oracle_check.hpp"
#include "experiments/run/timed/output.hpp"
#include "experiments/run/timed/run_result.hpp"
#include "experiments/run/timed/verdict.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// Scope in which only the root rank works and the other ranks wait.
class WorkAlone {
public:
  WorkAlone(Executor& executor, bool is_root) : executor_(executor), is_root_(is_root) {
    if (is_root_) work_alone(executor_, true);
  }
  WorkAlone(const WorkAlone&) = delete;
  WorkAlone& operator=(const WorkAlone&) = delete;
  ~WorkAlone() {
    if (is_root_) work_alone(executor_, false);
  }

private:
  Executor& executor_;
  bool is_root_;
};

/// One timed run; it fills in a RunResult.
class TimedRun {
public:
  /// All arguments must outlive this object. `outputs` receives the files of the run, and `result`
  /// is filled in.
  TimedRun(const RunPlan& plan, const RunRequest& request, FileSet& outputs, RunResult& result);

  void run();
  /// Takes so many samples of the same run, and makes the fastest the time of the result: other
  /// work only slows. Runs of a sample take at least `least_s` seconds together. The first run,
  /// which paused for inspections, is a sample if it took so long. Later runs pause nowhere if
  /// their steps are equal. After a change of the model there are no further samples: their start
  /// would not be that of the first. Sets the status of the result if the bits of a run differ.
  void take_samples(long samples, double least_s);

  /// The energy balance of the run, after run(). Short runs of small scenes are computed once more,
  /// with a look at each step; otherwise looks were taken on the way. Empty if the run has none,
  /// and on all ranks but the root. Sets the status of the result if the second run differs.
  std::optional<EnergyShares> energy_balance();

  /// The model that computed last, and the rotations with which the oracle has the same equations.
  Model model() const { return model_; }
  Rotation equations() const { return equations_of(plan_, model_); }
  Executor& executor() { return *executor_; }

private:
  std::unique_ptr<Executor> created(Model model);
  /// Runs some steps from the initial state, more and more until the time of the request is over.
  void warm_up();
  FrameSeries new_series() const {
    return {request_.is_root ? request_.output : "", plan_.frame_steps.size() > 1, outputs_};
  }

  /// Runs from the initial state to the end.
  /// @return false if the run stops early, or must start again with another model
  bool pass_all_stops();
  /// Steps at which the run pauses: ascending, the last step included.
  std::vector<long> stops() const;
  bool advance_to(long step, long stop, RunResult& result);
  /// Checks that the state is finite. Kernels check velocities within steps; this finds numbers
  /// that overflow in the last step before a pause.
  bool is_finite_after(long step);
  void report_breakdown(long step, const Outcome& outcome, RunResult& result) const;
  /// Runs from the initial state, again and again, until this took `least_s` seconds.
  RunResult sample(double least_s);

  AdaptiveSteps adaptive_steps();
  /// Advances by adaptive steps to the time that `stop` equal steps would reach.
  bool adapt_to(long stop);
  /// Repeats the whole adaptive run with the same pauses, because pauses cut steps. @return its
  /// time [s]
  double adapt_again(Usage& usage);

  void leap_again(RunResult& result); ///< the whole run with the same pauses

  void look(long step);
  void write_frame(long step);
  std::unique_ptr<Guard> made_guard(); ///< null if the request has none
  /// Steps from a step to the next pause of the guard, at most to `stop`.
  long steps_to_pause(long step, long stop) const;
  /// A step failed: the run is unstable, or faulty if the witness does not fail alike.
  void report_failure(long step, const Outcome& outcome, RunResult& result);
  /// Ends the run as faulty if the guard found other bits.
  /// @param difference  what it found, or empty
  bool is_sound(const std::string& difference, long step, RunResult& result);

  // The following functions save the run and continue it (timed_run_checkpoint.cpp).

  /// Begins to save the run, and continues from the checkpoint that was asked for.
  void begin_saving();
  void end_saving();
  void resume(SavedRun& saved);
  /// Before each chunk of steps: saves the run if that is due, and ends it if a signal asked.
  void save_or_end();
  /// @return one line if it could not be saved, else empty
  std::string save();
  /// Steps that were done; with adaptive steps, those that were accepted.
  long steps_done() const { return adaptive_ ? adaptive_->counts().accepted : step_; }
  /// True if the run that this one continues has looked at the state there.
  bool is_passed(long stop) const;
  /// Steps of the next chunk, at most `most`.
  long chunk(long most) const;
  long chunk_steps() const; ///< of a chunk while the run is saved
  std::vector<double> watch_kept();
  void take_watch(std::span<const double> kept);
  void show_progress(long step);

  // The following functions follow the energy (timed_run_energy.cpp).

  /// Follows the energy from the state that was written to the executor, after `step` steps.
  /// @param state  null: the initial state
  void begin_balance(long step, const std::vector<double>* state = nullptr);
  /// True if every step of the run is looked at.
  bool is_balanced_by_steps() const;
  /// Steps between looks on the way; 0: none.
  long balance_interval() const;
  /// Looks at the executor's state at a time [s].
  void look_at_energy(EnergyBalance& balance, double time);
  /// Computes the run again, with a look at each step.
  EnergyShares balance_by_steps();
  bool repeat_by_steps(EnergyBalance& balance);

  // The following functions watch a model of small rotations that --model auto chose
  // (timed_run_model.cpp).

  /// Advances to a pause and checks the error of the model on the way. If the error may exceed the
  /// tolerance, a larger model continues.
  bool advance_watched(long step, long stop);
  /// Replaces the model by a larger one.
  /// @param step  step at which the bound was exceeded
  /// @param resumed  step from which the run continues: the last good one, or 0 for the start
  /// @param relative_to  text that says what the error is relative to; empty for the largest motion
  /// so far
  /// @return false if the run must stop instead
  bool promote(long step, long resumed, Model to, const std::string& relative_to);
  void stop_at_bound(const Promotion& promotion, const std::string& relative_to);
  /// True if the error of smaller models is within the tolerance relative to the final state. A
  /// motion may end near its rest position, where its own values are small.
  bool holds_at_end();
  /// Restarts from the initial state with the present model: no intermediate state is known to be
  /// good.
  void begin_anew();

  const RunPlan& plan_;
  const RunRequest& request_;
  const Problem& problem_;
  FileSet& outputs_;
  RunResult& result_;
  bool has_begun_ = false;
  Model model_ = Model::spatial;
  std::unique_ptr<Executor> executor_;
  FrameSeries series_;
  bool is_root_;
  std::optional<RunHistory> history_; ///< of the root
  std::optional<AdaptiveSteps> adaptive_;
  /// Error bounds of the models that ran before the spatial model; the spatial model has no bound.
  struct LeftOut {
    KindBounds errors;
    double tolerance;
  };
  std::optional<LeftOut> left_out_;
  /// State after `step` steps from which the present model computes.
  struct BalanceStart {
    std::vector<double> state;
    long step = 0;
  };
  std::optional<BalanceStart> balance_start_;
  std::optional<EnergyBalance> balance_; ///< if it is followed on the way
  bool has_looks_at_energy_ = false;     ///< on the way
  DeviceUse used_by_looks_;
  OracleCheck oracle_check_;
  std::optional<AccuracyMeter> meter_;
  /// set if --model auto chose a model of small rotations
  std::optional<ModelMonitor> monitor_;
  long step_ = 0; ///< steps done, unless steps are adaptive
  std::optional<RunIdentity> identity_;
  bool is_watched_ = false; ///< of a run that is saved: the error of a small model
  /// Set while the run is saved: not during its warm-up.
  std::optional<CheckpointClock> saved_;
  std::optional<InterruptsDeferred> interrupts_;
  std::unique_ptr<Guard> guard_;   ///< not during the warm-up
  std::optional<FlippedBit> flip_; ///< likewise
  std::optional<Progress> progress_;
  Clock::time_point shown_; ///< when the progress was shown last, or began
  bool is_progress_shown_ = false;
};

} // namespace dss
