#include "experiments/base/interrupt.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_summary.hpp"
#include "experiments/run/checkpoint/checkpoint.hpp"
#include "experiments/run/ensemble/ensemble_plan.hpp"
#include "experiments/run/ensemble/ensemble_run.hpp"
#include "experiments/run/guard/guard.hpp"
#include "experiments/run/plan/job.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/statics/analysis.hpp"
#include "experiments/run/timed/run.hpp"
#include "experiments/run/timed/run_record.hpp"
#include "solver/decomposition/decomposition_file.hpp"
#include "solver/error.hpp"
#include "solver/scene/scene_text.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>

namespace dss {
namespace {

struct RunArguments {
  RunRequest request;
  AnalysisRequest analysis;
  std::vector<std::string> set;
};

/// Reports all mistakes that can be found without ranks before any rank is started.
void require_startable(RunRequest request) {
  request.is_model_auto = true;
  if (request.ranks > most_ranks_here())
    throw InputError(fmt::format("--ranks {}: more than {} are too many for this machine; start "
                                 "them by mpirun and your hosts",
                                 request.ranks, most_ranks_here()));
  if (request.ensemble.empty()) {
    const RunPlan plan = plan_run(request);
    require_sound_guard(request, plan);
    decomposition_for(plan.scene.problem, request.decomposition, request.ranks);
  } else
    plan_ensemble(request);
}

/// Parts of ranks and hybrids choose their tiles themselves.
void require_no_tile_of_parts(const RunRequest& request) {
  const bool has_parts = request.ranks > 1 || !request.hybrid.empty() ||
                         request.variant == "hybrid" || request.variant.starts_with("mpi");
  if (request.tile > 0 && has_parts)
    throw InputError(fmt::format("--tile {}: ranks and hybrids choose the tiles of their parts; "
                                 "give none",
                                 request.tile));
}

/// The file of members, and the voxel files that members name.
void read_ensemble_files(const RunRequest& request, CommandFiles& files) {
  files.read("--ensemble", request.ensemble);
  for (const MemberSet& member : read_members(request.ensemble)) {
    if (member.set.empty()) continue;
    std::vector<Override> overrides = request.overrides;
    overrides.insert(overrides.end(), member.set.begin(), member.set.end());
    files.read_scene(request.scene, overrides);
  }
}

/// No output may replace a file that the run reads, or another output.
void require_distinct_files(const RunRequest& request, const std::string& analysis) {
  CommandFiles files;
  files.read_scene(request.scene, request.overrides);
  const bool has_members = !request.ensemble.empty();
  if (request.ensemble.ends_with(".json") || request.ensemble.ends_with(".csv"))
    read_ensemble_files(request, files);
  if (is_file(request.decomposition)) files.read("--decomposition", request.decomposition);
  files.read("--check-state", request.check_state);
  files.read("--reference", request.reference);
  // A run may go on saving itself where it was saved.
  if (request.restart != request.checkpoint &&
      request.restart != earlier_checkpoint(request.checkpoint))
    files.read("--restart", request.restart);
  files.write("--json", request.json);
  if (!request.checkpoint.empty()) {
    files.write("--checkpoint", request.checkpoint);
    files.write("--checkpoint", earlier_checkpoint(request.checkpoint));
  }
  if (has_members) {
    files.write_members("--state", request.state_csv);
    files.write_members("--output", request.output);
    if (request.frames > 0 && !request.output.empty())
      files.write_members("--output",
                          std::filesystem::path(request.output).replace_extension(".pvd").string());
  } else {
    files.write("--state", request.state_csv);
    if (request.frames > 0 || analysis == "modal")
      files.write_series("--output", request.output);
    else
      files.write("--output", request.output);
  }
  files.require_distinct();
}

/// Runs an ensemble. One line names the members that failed, after the others have been written.
int run_members(const RunRequest& request) {
  const EnsembleResult result = run_ensemble(request);
  const RunResult& whole = result.whole;
  if (!request.json.empty() && request.is_root)
    write_json(request.json, ensemble_json(request, result));
  if (request.json != "-") print_ensemble(result);
  if (whole.status == "ok") return exit_success;
  fmt::print(stderr, "dssbench: {}: {}\n", whole.scene, whole.reason);
  return whole.status == "unstable" ? exit_unstable : exit_check_failed;
}

int run(const CLI::App& command, const RunArguments& arguments) {
  RunRequest request = arguments.request;
  request.overrides = parse_overrides(arguments.set);
  const std::string analysis = chosen_analysis(command, request, arguments.analysis);
  if (request.ensemble.empty() && command.count("--ensemble") > 0)
    throw InputError("--ensemble: give a file that ends in .json or .csv, or a number of members");
  if (analysis != "dynamic" && !request.ensemble.empty())
    throw InputError("--ensemble: members are computed in time; give --analysis dynamic");
  if (request.guard == 0 &&
      command.count("--guard") + command.count("--guard-steps") + command.count("--guard-variant") >
          0)
    throw InputError("--guard: give 1 step or more between two looks");
  if (!request.ensemble.empty() && request.guard != 0)
    throw InputError("--ensemble: ensembles have no guard; leave --guard out, or run members by "
                     "themselves");
  for (const auto& [option, file] :
       {std::pair("--checkpoint", request.checkpoint), std::pair("--restart", request.restart)})
    if (command.count(option) > 0 && file.empty())
      throw InputError(fmt::format("{}: its name is empty; give a file", option));
  if (command.count("--checkpoint-every") > 0 && request.checkpoint.empty())
    throw InputError("--checkpoint-every: give --checkpoint FILE, too");
  require_distinct_files(request, analysis);
  if (analysis != "dynamic") return run_analysis(analysis, request, arguments.analysis);
  // the user started mpirun
  if (job_rank().ranks > 1 && request.ranks == 1) request.ranks = job_rank().ranks;
  require_no_tile_of_parts(request);
  if (request.ranks > 1 && !job_rank().is_started) {
    require_startable(request);
    if (!request.checkpoint.empty()) {
      constexpr double patience_s = 600; // a large state takes long to write
      let_ranks_save(patience_s);
      say_when_interrupted(fmt::format("{0} has what was saved last; give the command "
                                       "again with --restart {0}",
                                       request.checkpoint));
    }
    return run_on_ranks(request.ranks, request.threads);
  }
  request.is_root = job_rank().is_root();
  request.is_model_auto = true;
  if (!request.ensemble.empty()) return run_members(request);
  const RunResult result = run_scene(request);
  if (!request.json.empty() && request.is_root) write_json(request.json, run_json(request, result));
  if (result.status == "unstable") throw UnstableError(result.reason);
  const bool has_end = result.status == "ok" || result.status == "wrong";
  if (request.json != "-" && has_end) print_summary(result);
  if (result.status == "ok") return exit_success;
  fmt::print(stderr, "dssbench: {}: {}\n", result.scene, result.reason);
  return exit_check_failed;
}

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
  command.add_option("--output", request.output, "F.vtu: file for the final state, for ParaView");
  command
      .add_option("--frames", request.frames,
                  "Write a series instead of F.vtu: F_0000.vtu (the start) to F_<frames>.vtu, "
                  "listed in F.pvd")
      ->capture_default_str();
  command.add_option("--state", request.state_csv,
                     "F.csv: file for the final state, one row per element");
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

void add_run_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("run", "Run one scene on one variant, and write the requested files");
  const auto arguments = std::make_shared<RunArguments>();
  RunRequest& request = arguments->request;
  command->add_option("SCENE", request.scene, "A name from `dssbench list scenes`, or a path")
      ->required();
  add_where_options(*command, request, arguments->set);
  add_rank_options(*command, request);
  add_model_options(*command, request);
  add_step_options(*command, request);
  add_output_options(*command, request);
  add_checkpoint_options(*command, request);
  add_guard_options(*command, request);
  add_check_options(*command, request);
  command->footer("Example: dssbench run plate_paper --set n=100 --steps 500 --variant avx2 "
                  "--threads 2 --output plate.vtu");
  add_analysis_options(*command, arguments->analysis);
  command->callback([arguments, command, &chosen] {
    chosen = [arguments, command] { return run(*command, *arguments); };
  });
}

} // namespace dss
