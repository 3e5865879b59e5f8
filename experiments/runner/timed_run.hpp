#pragma once
/// A run on an executor, from the initial state to the end: advanced by pieces between the steps at which somebody looks, with nothing timed but advance().
#include "experiments/runner/adaptive_steps.hpp"
#include "experiments/runner/output.hpp"
#include "experiments/runner/run.hpp"
#include "experiments/runner/run_plan.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// While one lives, this rank does what only one need do, and the others wait.
class WorkAlone {
public:
  WorkAlone(Executor& executor, bool is_root) : executor_(executor), is_root_(is_root) {
    if (is_root_) executor_.work_alone(true);
  }
  WorkAlone(const WorkAlone&) = delete;
  WorkAlone& operator=(const WorkAlone&) = delete;
  ~WorkAlone() {
    if (is_root_) executor_.work_alone(false);
  }

private:
  Executor& executor_;
  bool is_root_;
};

class TimedRun {
public:
  /// All three must outlive it; `result` is filled in as the run goes.
  TimedRun(const RunPlan& plan, const RunRequest& request, RunResult& result);

  void run(long warmup_steps);
  /// Times a short run anew: from the start, until the clock has run for `least_s`; one of equal steps straight through. The run
  /// that was looked at while it went warms up.
  void repeat(double least_s);

  /// Model that computed last, and the oracle's rotations that have its equations.
  Model model() const { return model_; }
  Rotation equations() const { return plan_.rotation == Rotation::quaternion ? rotation_of(model_) : plan_.rotation; }
  Executor& executor() { return *executor_; }

private:
  std::unique_ptr<Executor> created(Model model);
  FrameSeries new_series() const { return {request_.is_root ? request_.output : "", plan_.frame_steps.size() > 1}; }

  /// From the initial state to the end. @return false if the run ends before, or must begin anew with another model
  bool pass_all_stops();
  /// Steps at which the run pauses, ascending, the last step among them.
  std::vector<long> stops() const;
  bool advance_to(long step, long stop, RunResult& result);
  /// Kernels watch velocities; a number that left the range first in the very step at which somebody looks is found here.
  bool is_finite_after(long step);
  void report_breakdown(long step, const Outcome& outcome, RunResult& result) const;
  void sum_over_ranks(const Traffic& before);

  AdaptiveSteps adaptive_steps();
  /// To the time of that step, were all as long as the first.
  bool adapt_to(long stop);
  /// The whole adaptive run once more, past the same stops, which steps are cut to. @return its time [s]
  double adapt_again(Usage& usage);

  void look(long step);
  /// A leapfrog cannot start anew from a state without its half-step velocities, so only Runge-Kutta runs have their
  /// ends checked.
  bool has_tail() const;
  long tail_start() const;
  void check_tail();

  // Of a model of small rotations that auto chose (timed_run_model.cpp):

  /// To a stop, with looks at the error of the model on the way; a larger model goes on where it may exceed the tolerance.
  bool advance_watched(long step, long stop);
  /// @param step  at which the bound was exceeded  @param resumed  from whose state the run goes on; the last good one, or 0 for the start
  /// @param relative_to  in words, where it is not the largest motion so far
  /// @return false if the run is to stop instead
  bool promote(long step, long resumed, Model to, const std::string& relative_to);
  void stop_at_bound(const Promotion& promotion, const std::string& relative_to);
  /// Whether what smaller models left out is within the tolerance of the end: a motion may end where it passes its rest.
  bool holds_at_end();
  /// Nothing between is known to be good.
  void begin_anew();

  const RunPlan& plan_;
  const RunRequest& request_;
  const Problem& problem_;
  RunResult& result_;
  bool has_begun_ = false;
  Model model_ = Model::spatial;
  std::unique_ptr<Executor> executor_;
  FrameSeries series_;
  bool is_root_;
  std::optional<AdaptiveSteps> adaptive_;
  /// By models before the spatial one, which has no bound to keep.
  struct LeftOut {
    KindBounds errors;
    double tolerance;
  };
  std::optional<LeftOut> left_out_;
  std::vector<double> tail_state_;
  std::optional<AccuracyMeter> meter_;
  std::optional<ModelMonitor> monitor_; ///< while the model is one of small rotations that auto chose
};

} // namespace dss
