#include "experiments/cli/run_options.hpp"

#include "experiments/cli/arguments.hpp"
#include "experiments/run/plan/names.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dss {
namespace {

/// Options that say what is computed, where and by how many.
void add_where_options(CLI::App& command, RunRequest& request, std::vector<std::string>& set) {
  command
      .add_option("--set", set, "Override a parameter or any number of the scene; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command.add_option(
      "--ensemble", request.ensemble,
      "F.json or F.csv: run the scene once for each member of this file, with the "
      "member's own values of --set, all side by side; or a number of equal members");
  command
      .add_option("--variant", request.variant,
                  "A name from `dssbench list variants`; auto: the fastest here")
      ->capture_default_str()
      ->type_name("VARIANT");
  command
      .add_option("--device", request.device,
                  "For a variant on devices: P:D from `dssbench list devices`, cpu, gpu, or a "
                  "part of a device's name (default: the first device)")
      ->type_name("DEVICE");
  command.add_option(
      "--hybrid", request.hybrid,
      "Members that compute the scene together, VARIANT[@DEVICE][:THREADS][=WEIGHT],...; auto: the "
      "best members here, or the fastest one alone; with --ranks one member per rank");
  command.add_option("--threads", request.threads, "Threads of the variant")->capture_default_str();
  command
      .add_option(
          "--tile", request.tile,
          "Width of a tile [rows across the sweep; of a plate, elements of a row] (default: "
          "as many as suit the caches)")
      ->check(CLI::Range(1, 1 << 30));
  command
      .add_option("--ranks", request.ranks,
                  "Number of processes; each computes a part of the scene")
      ->capture_default_str();
}

/// Options of several ranks.
void add_rank_options(CLI::App& command, RunRequest& request) {
  command
      .add_option("--decomposition", request.decomposition,
                  fmt::format("How to divide the scene into parts: {}, or a file of "
                              "`dssbench decompose`",
                              fmt::join(names_of("DECOMPOSITION"), ", ")))
      ->capture_default_str()
      ->type_name("DECOMPOSITION")
      ->group("Ranks");
  command
      .add_option("--halo", request.halo,
                  fmt::format("How ranks exchange their halos: {}; auto: the fastest in a short "
                              "trial",
                              fmt::join(names_of("HALO"), ", ")))
      ->capture_default_str()
      ->type_name("HALO")
      ->group("Ranks");
  command
      .add_option(
          "--shares", request.shares,
          "Sizes of the parts: equal, or measured (by each rank's speed, measured before the run)")
      ->capture_default_str()
      ->type_name("SHARES")
      ->group("Ranks");
}

/// Options of model, numbers and method.
void add_model_options(CLI::App& command, RunRequest& request) {
  command
      .add_option("--model", request.model,
                  "auto (default, unless the scene names one): the smallest sufficient model, as "
                  "`dssbench explain` says; or " +
                      fmt::format("{}", fmt::join(model_names(), ", ")))
      ->type_name("MODEL");
  command.add_option("--model-tolerance", request.model_tolerance,
                     "With --model auto: largest relative error of a model of small rotations "
                     "(default: the scene's tolerance of a run)");
  command
      .add_option("--on-bound", request.on_bound,
                  "With --model auto, if the error of small rotations may exceed the tolerance: "
                  "promote (continue with a larger model from the last good state) or stop")
      ->capture_default_str()
      ->type_name("BOUND");
  command
      .add_option("--precision", request.precision,
                  "f64, f32, or f32c: f32 with compensated sums of the state (default: f64)")
      ->type_name("PRECISION");
  command
      .add_option("--integrator", request.integrator,
                  fmt::format("{} (default: the scene's)", fmt::join(method_names(), ", ")))
      ->type_name("INTEGRATOR");
  command
      .add_option("--rotation", request.rotation,
                  fmt::format("{} (default: quaternion); only the variant reference has the others",
                              fmt::join(names_of("ROTATION"), ", ")))
      ->type_name("ROTATION");
}

/// Options of the step.
void add_step_options(CLI::App& command, RunRequest& request) {
  command.add_option("--dt", request.dt, "Time step [s] (default: the scene's)");
  command.add_option("--steps", request.steps, "Number of steps (default: the scene's)");
  command.add_option("--rtol", request.rtol,
                     "With --integrator dopri5: adaptive steps. The error of each step stays "
                     "below this share of the largest displacement, velocity, rotation and spin "
                     "so far. --dt is the first step; the end of the run is --steps times --dt");
  command.add_option(
      "--atol", request.atol,
      "With --rtol: absolute error that is allowed in addition, in SI units (default: 0)");
  command.add_flag("--force", request.is_forced, "Run above the predicted stability limit");
  command
      .add_option("--stability-limit", request.stability_limit,
                  "Largest stable step [s] of the scene and the integrator, from `dssbench "
                  "stability`; it is then not predicted again")
      ->group("Checks");
}

/// Options of files.
void add_output_options(CLI::App& command, RunRequest& request) {
  command.add_option("--output", request.output,
                     "F.vtu: file for the final state, for ParaView. F.vtkhdf: the same as VTKHDF, "
                     "with all states of --frames in it");
  command
      .add_option("--frames", request.frames,
                  "Write a series instead of F.vtu: F_0000.vtu (the start) to F_<frames>.vtu, "
                  "listed in F.pvd")
      ->capture_default_str();
  command.add_option("--state", request.state_csv,
                     "F.csv: file for the final state, one row per element");
  command.add_option("--picture", request.picture,
                     "F.svg: picture of the final state: von Mises stress on the deformed body");
  command
      .add_option("--probe", request.probes,
                  "NAME=BODY,x,y,z: a place in a body, in m at rest. The history has its "
                  "displacement, velocity and stress. May be given several times")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--history", request.history,
                     "F.csv: file for energies, reactions and probes over time (default with "
                     "--probe or --every: history.csv)");
  command.add_option("--every", request.every,
                     "Steps between two rows of the history (default: at most 1,000 rows, fewer "
                     "of large bodies). With --rtol, each row ends a step");
  command.add_option("--json", request.json, "File for the result, or - for standard output");
}

/// Options of saved runs.
void add_checkpoint_options(CLI::App& command, RunRequest& request) {
  command
      .add_option("--checkpoint", request.checkpoint,
                  "File that says where the run stands, at times, at its end, and when a signal "
                  "ends it; the one before is kept as FILE.previous")
      ->group("Checkpoints");
  command
      .add_option("--checkpoint-every", request.checkpoint_every,
                  "Time or number of steps between two checkpoints: 60s, 10000")
      ->capture_default_str()
      ->group("Checkpoints");
  command
      .add_option("--restart", request.restart,
                  "Continue the run of a checkpoint. The bits are those of an uninterrupted run, "
                  "with any --threads, --ranks and --variant that rounds alike")
      ->group("Checkpoints");
}

/// Options of guarded runs.
void add_guard_options(CLI::App& command, RunRequest& request) {
  command
      .add_option("--guard", request.guard,
                  "Every so many steps, another variant computes --guard-steps steps again; if a "
                  "bit differs, the run ends")
      ->group("Guard");
  command
      .add_option("--guard-steps", request.guard_steps,
                  "Steps that are computed again, of those of --guard")
      ->capture_default_str()
      ->group("Guard");
  command
      .add_option("--guard-variant", request.guard_variant,
                  "Variant that computes them; it must round alike; auto: the fastest other one")
      ->capture_default_str()
      ->type_name("VARIANT")
      ->group("Guard");
}

/// Options for studies.
void add_check_options(CLI::App& command, RunRequest& request) {
  command
      .add_option("--warmup", request.warmup_steps,
                  "Steps before the clock starts; the state is then reset")
      ->capture_default_str()
      ->group("Checks");
  command
      .add_option("--warmup-time", request.warmup_s,
                  "Least time of the warm-up of several workers [s]; for kernels that leave new "
                  "threads on one processor at first")
      ->capture_default_str()
      ->group("Checks");
  command
      .add_option("--check-state", request.check_state,
                  "Compare with the oracle's state in this file (made by `experiment`)")
      ->group("Checks");
  command.add_option("--check-step", request.check_step, "Step of that state; 0: as the file says")
      ->capture_default_str()
      ->group("Checks");
  command
      .add_option("--check-tail", request.check_tail,
                  "Number of last steps of a longer run that the oracle repeats; 0: none")
      ->capture_default_str()
      ->group("Checks");
  command
      .add_option("--reference", request.reference,
                  "Measure errors against the solution in this file (made by studies of "
                  "precision), at its saved times; they also set the number of steps")
      ->group("Checks");
  command
      .add_option(
          "--repeat-for", request.repeat_for,
          "Repeat a shorter run until this time was measured [s]; times are the mean of the runs")
      ->capture_default_str()
      ->group("Checks");
  command
      .add_option("--samples", request.samples,
                  "Time the run so many times; the fastest counts, because other work only slows")
      ->capture_default_str()
      ->group("Checks");
  command
      .add_flag("!--no-balance", request.has_balance,
                "Do not follow the energy: for repetitions of a run that was judged")
      ->group("Checks");
}

} // namespace

void add_run_options(CLI::App& command, RunArguments& arguments) {
  RunRequest& request = arguments.request;
  command.add_option("SCENE", request.scene, "A name from `dssbench list scenes`, or a path")
      ->required();
  add_where_options(command, request, arguments.set);
  add_rank_options(command, request);
  add_model_options(command, request);
  add_step_options(command, request);
  add_output_options(command, request);
  add_checkpoint_options(command, request);
  add_guard_options(command, request);
  add_check_options(command, request);
  add_analysis_options(command, arguments.analysis);
}

} // namespace dss
