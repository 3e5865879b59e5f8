#pragma once
/// One run of one scene on one variant: the body of `dssbench run`.
#include "experiments/runner/model/model_monitor.hpp"
#include "experiments/runner/precision/accuracy.hpp"
#include "experiments/runner/precision/saved_times.hpp"
#include "experiments/runner/usage.hpp"
#include "solver/model/model.hpp"
#include "solver/numerics/step_control.hpp"
#include "solver/scene/scene.hpp"
#include "variants/device.hpp"
#include "variants/distribution.hpp"
#include "variants/member.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace dss {

/// What the user asked for; what is absent comes from the scene.
struct RunRequest {
  std::string scene;
  std::vector<Override> overrides;
  std::string variant = "auto";
  int threads = 1;
  int ranks = 1;
  std::string decomposition = "strips", halo = "auto", shares = "equal"; ///< see Distribution
  std::string device; ///< of a variant on devices, see choose_device; empty: its first
  std::string hybrid; ///< members, see parse_members, or "auto"; empty: no hybrid
  std::optional<std::string> model, precision, integrator, rotation;
  bool is_model_auto = false;            ///< where neither `model` nor the scene names one; else it is spatial
  std::optional<double> model_tolerance; ///< of the error of a model of auto; the scene's, without
  std::string on_bound = "promote";      ///< or "stop": what a run does whose model's error may exceed the tolerance
  std::optional<double> dt;              ///< [s]
  std::optional<long> steps;
  std::optional<double> rtol, atol;      ///< with rtol steps are adaptive
  bool is_root = true;                   ///< of several ranks all do the same, and one writes
  bool is_forced = false;                ///< run above the stability limit
  std::optional<double> stability_limit; ///< known from before, and not predicted again [s]
  long warmup_steps = 0;                 ///< steps before the clock starts; the state then starts anew
  std::string output;                    ///< .vtu file, or empty
  int frames = 0;                        ///< files of a series besides the final one
  std::string state_csv;                 ///< or empty
  std::string json;                      ///< file, "-" for standard output, or empty
  std::string check_state;               ///< file of the oracle's state, or empty
  long check_step = 0;                   ///< the step of that state
  long check_tail = 2;                   ///< steps at the end of a longer run that the oracle checks; 0: none
  std::string reference;                 ///< file of the scene's solution, which errors are measured against, or empty
  double repeat_for = 0;                 ///< a shorter run starts again and again until so much time was measured [s]
};

/// A comparison with the oracle.
struct CheckResult {
  bool is_done = false;
  std::string how; ///< "oracle after 100 steps, and over the last 2"
  double tolerance = 0;
  double error = 0;                 ///< after check_step steps
  std::optional<double> tail_error; ///< of the last steps, where the run went on
  bool is_passed() const { return error <= tolerance && (!tail_error || *tail_error <= tolerance); }
};

/// A comparison with the solution of the scene.
struct ReferenceResult {
  SavedTimes times;
  double error = 0; ///< of the solution itself
  Accuracy accuracy;
};

struct RunResult {
  std::string scene, variant, isa, model, precision, integrator, rotation, schedule;
  bool has_fma = false; ///< its bits are those of every other variant that has FMA
  int threads = 1;
  int workers = 1; ///< threads that compute, on all ranks: fewer than `threads` each where the scene has too few rows
  RankInfo ranks;
  DeviceUse device_use; ///< in the timed steps; of rank 0
  HybridInfo hybrid;
  double messages_per_step = 0, bytes_per_step = 0; ///< sent by all ranks
  double communication_share = 0;                   ///< of the wall time, mean over the ranks
  std::size_t elements = 0, links = 0, bytes = 0;
  long steps = 0, warmup_steps = 0;
  int stages = 0; ///< force evaluations a step
  double dt_s = 0, stability_limit_s = 0, wall_s = 0;
  long runs = 1;                         ///< that were timed: wall_s is their mean, usage their sum
  double end_s = 0;                      ///< of the run
  std::optional<StepTolerance> adaptive; ///< dt_s is then the first step tried, `steps` those that were accepted
  long rejected_steps = 0;
  double least_step_s = 0, largest_step_s = 0; ///< of the accepted ones
  std::optional<double> evaluations;           ///< of all forces, where their number is known
  double first_step_s = 0;                     ///< time to the first step: making the executor, and the very first step
  Usage usage;
  std::optional<double> energy_j;     ///< absent for states too large to hold twice
  std::optional<double> energy_drift; ///< relative, of the whole run, where energy is conserved and some is there
  double max_displacement_m = 0;
  std::uint64_t digest = 0;
  ModelChoice model_choice;
  ModelReport model_report;
  CheckResult check;
  std::optional<ReferenceResult> reference;
  std::vector<std::string> files;                           ///< written, in words
  std::string status = "ok", reason;                        ///< "unstable", "wrong", "bound": what, where
  double sample_s() const { return wall_s * double(runs); } ///< under the clock [s]
  double element_steps_per_s() const { return wall_s > 0 ? double(elements) * double(steps) / wall_s : 0; }
};

/// Runs, and writes the output files asked for. A run that leaves the finite numbers has the status "unstable", one
/// that fails its check "wrong", one that was to stop where its model's error may exceed the tolerance "bound".
/// @throws InputError for anything wrong with the request, UnstableError for a step above the predicted limit that is
/// not forced
RunResult run_scene(const RunRequest& request);

/// How every record begins: the context, the scene and its overrides.
nlohmann::ordered_json record_of(const std::string& scene, const std::vector<Override>& overrides);

/// The keys of DESIGN.md section 7 and those of the record; with the context in Google Benchmark's layout.
nlohmann::ordered_json run_json(const RunRequest& request, const RunResult& result);

} // namespace dss
