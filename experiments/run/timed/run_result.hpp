#pragma once
/// The result of a run.
#include "experiments/base/usage.hpp"
#include "experiments/run/model/model_monitor.hpp"
#include "experiments/run/state/accuracy.hpp"
#include "experiments/run/state/saved_times.hpp"
#include "solver/model/energy_balance.hpp"
#include "solver/model/reactions.hpp"
#include "solver/numerics/step_control.hpp"
#include "variants/api/device.hpp"
#include "variants/api/distribution.hpp"
#include "variants/api/member.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dss {

/// A comparison with the oracle.
struct CheckResult {
  bool is_done = false;
  std::string how; ///< "oracle after 100 steps, and over the last 2"
  double tolerance = 0;
  double error = 0; ///< relative error after the checked number of steps
  /// error over the last steps, if the run is longer than the checked state
  std::optional<double> tail_error;
  bool is_passed() const { return error <= tolerance && (!tail_error || *tail_error <= tolerance); }
};

/// A comparison with the solution of the scene.
struct ReferenceResult {
  SavedTimes times;
  double error = 0; ///< estimated error of the solution itself
  Accuracy accuracy;
};

/// How a run was guarded (experiments/run/guard).
struct GuardReport {
  std::string witness;    ///< variant that computed steps once more
  long every = 0;         ///< steps between two looks
  long steps = 0;         ///< of each look
  long checks = 0;        ///< comparisons
  long checked_steps = 0; ///< that were computed once more
  double time_s = 0;      ///< not part of wall_s
};

/// Everything that a run reports. run_fields.hpp lists the meaning of each field.
struct RunResult {
  std::string scene, variant, isa, model, precision, integrator, rotation, schedule;
  bool has_fma = false; ///< its bits equal those of every other variant with FMA
  int threads = 1;
  /// Threads that compute, on all ranks. If the scene has too few rows, a rank uses fewer than
  /// `threads`.
  int workers = 1;
  RankInfo ranks;
  DeviceUse device_use; ///< of rank 0, during the timed steps
  HybridInfo hybrid;
  FactorInfo factors;                               ///< up to the end of the run
  double messages_per_step = 0, bytes_per_step = 0; ///< sent by all ranks
  double communication_share = 0;                   ///< share of the wall time, mean over the ranks
  std::size_t elements = 0, links = 0, bytes = 0;
  long steps = 0, warmup_steps = 0;
  long resumed_step = 0; ///< from which the run continued; 0: it began at the start
  int stages = 0;        ///< force evaluations per step
  double dt_s = 0, stability_limit_s = 0, wall_s = 0;
  long samples = 1; ///< number of samples, of which the fastest counts
  long runs = 1;    ///< runs of that sample: wall_s is their mean, usage their sum
  double end_s = 0; ///< end time of the run [s]
  /// With adaptive steps, dt_s is the first step and `steps` counts accepted steps.
  std::optional<StepTolerance> adaptive;
  long rejected_steps = 0;
  double least_step_s = 0, largest_step_s = 0; ///< of accepted steps
  std::optional<double> evaluations; ///< force evaluations of each element; empty if unknown
  double first_step_s = 0;           ///< time to make the executor and to do the very first step
  Usage usage;
  std::optional<double> energy_j; ///< absent if the state is too large to hold twice
  /// In the final state; absent without clamps, and as energy_j.
  std::optional<Reactions> reactions;
  /// Relative change over the whole run; only if energy is conserved and not zero.
  std::optional<double> energy_drift;
  std::optional<EnergyShares> balance; ///< absent if the state is too large to follow
  /// Predicted as stability_limit_s, at the final state; absent for large scenes.
  std::optional<double> stability_limit_end_s;
  double max_displacement_m = 0;
  std::uint64_t digest = 0;
  ModelChoice model_choice;
  ModelReport model_report;
  CheckResult check;
  std::optional<ReferenceResult> reference;
  std::optional<GuardReport> guard;
  std::vector<std::string> files;  ///< written files, as text
  std::vector<std::string> probes; ///< what they saw, as text
  /// status other than "ok": "unstable", "wrong", "bound", "faulty"; reason: what happened, and
  /// where
  std::string status = "ok", reason;
  /// Elements x steps, if not all elements took all steps: of an ensemble.
  std::optional<double> element_steps;
  long advanced_steps() const { return steps - resumed_step; } ///< that this run computed
  double sample_s() const { return wall_s * double(runs); }    ///< time of that sample [s]
  double element_steps_per_s() const {
    const double computed = double(elements) * double(advanced_steps());
    return wall_s > 0 ? element_steps.value_or(computed) / wall_s : 0;
  }
};

} // namespace dss
