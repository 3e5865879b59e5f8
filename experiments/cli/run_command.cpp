#include "experiments/base/cores.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run/plan/job.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/statics/analysis.hpp"
#include "experiments/run/timed/run.hpp"
#include "experiments/run/timed/run_record.hpp"
#include "solver/decomposition/decomposition_file.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <cstdio>
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

void print_device(const RunResult& result) {
  const DeviceUse& use = result.device_use;
  const double steps = double(result.steps);
  if (!use.device.id.empty())
    fmt::print("device {} ({}): built in {:.3g} s{}, a step {:.4g} launches of {:.3g} us, {:.4g} "
               "bytes to and {:.4g} "
               "from it in {:.3g} us\n",
               use.device.id, use.device.name, use.build_s, use.is_cached ? " from the cache" : "",
               use.launches / steps, 1e6 * use.launch_s, use.to_device_bytes / steps,
               use.from_device_bytes / steps, 1e6 * use.transfer_s / steps);
  if (result.hybrid.members.empty()) return;
  std::vector<std::string> members;
  for (const HybridInfo::Entry& entry : result.hybrid.members)
    members.push_back(fmt::format("{} {:.1f} % of the elements, {:.4g} million element-steps/s",
                                  entry.member, 100 * entry.share, 1e-6 * entry.speed));
  fmt::print("hybrid: {}; re-balanced {} times{}{}\n", fmt::join(members, "; "),
             result.hybrid.rebalances, result.hybrid.reason.empty() ? "" : "; ",
             result.hybrid.reason);
}

void print_model(const RunResult& result) {
  const ModelChoice& choice = result.model_choice;
  if (choice.asked != "auto") return;
  fmt::print("model {}: {}\n", name(choice.chosen), choice.why);
  const ModelReport& report = result.model_report;
  if (choice.is_bounded)
    fmt::print("largest rotation within the bound {:.3g} rad, error of the model at most {:.3g}, "
               "{} looks\n",
               report.largest_rotation, report.estimate, report.looks);
  for (const Promotion& promotion : report.promotions)
    fmt::print("promoted from {} to {}: after step {} the error may be {:.3g}; on from step {}\n",
               name(promotion.from), name(promotion.to), promotion.step, promotion.estimate,
               promotion.resumed_step);
}

void print_balance(const RunResult& result) {
  if (result.balance && result.balance->is_resolved) {
    const EnergyShares& shares = *result.balance;
    fmt::print("energy balance: {:.4g} J at the start, {:+.4g} J by loads, {}; {}\n", shares.start,
               shares.work,
               shares.is_complete ? fmt::format("{:.4g} J to dampers", shares.dissipated)
                                  : "an unknown part to dampers",
               shares.is_complete ? fmt::format("error {:.2g} of the energy", shares.error)
                                  : fmt::format("gained at most {:.2g} of the energy",
                                                std::max(0.0, shares.error)));
  }
  if (const auto& limit = result.stability_limit_end_s; limit && result.dt_s > *limit)
    fmt::print("the step is above the stability limit of the final state, {:.6g} s; a longer run "
               "may grow\n",
               *limit);
}

void print_summary(const RunResult& result) {
  fmt::print("{}: {} elements, {} links, {} steps of {}{:g} s ({}, {}, {})\n", result.scene,
             result.elements, result.links, result.steps, result.adaptive ? "first " : "",
             result.dt_s, result.model, result.precision, result.integrator);
  print_model(result);
  fmt::print("{} ({}), {} thread{}{}, {}\n", result.variant, result.isa, result.threads,
             result.threads == 1 ? "" : "s",
             result.workers < result.threads ? fmt::format(" ({} with work)", result.workers) : "",
             result.schedule);
  if (const int cores = usable_cores(), busy = std::min(result.threads, result.workers);
      busy > cores)
    fmt::print("{} threads share {} core{}: a time that says nothing of speed\n", busy, cores,
               cores == 1 ? "" : "s");
  fmt::print("wall {:.6g} s{}, {:.4g} million element-steps/s, {:.1f} bytes an element\n",
             result.wall_s, result.runs > 1 ? fmt::format(" (mean of {} runs)", result.runs) : "",
             1e-6 * result.element_steps_per_s(), double(result.bytes) / double(result.elements));
  if (result.adaptive)
    fmt::print("adaptive, rtol {:g}, atol {:g}: {} steps of {:.3g} to {:.3g} s accepted, {} "
               "rejected, to t = {:g} s\n",
               result.adaptive->rtol, result.adaptive->atol, result.steps, result.least_step_s,
               result.largest_step_s, result.rejected_steps, result.end_s);
  fmt::print("time to the first step {:.3g} s\n", result.first_step_s);
  print_device(result);
  fmt::print("largest displacement {:.6g} m, energy {}, state {:016x}\n", result.max_displacement_m,
             result.energy_j ? fmt::format("{:.6g} J", *result.energy_j)
                             : "not computed (large state)",
             result.digest);
  if (result.check.is_done)
    fmt::print("check: {} ({}): error {:.3g}, tolerance {:.3g}\n",
               result.check.is_passed() ? "passed" : "failed", result.check.how, result.check.error,
               result.check.tolerance);
  if (result.reference)
    fmt::print("displacements against the solution at {} times: error {:.3g} at the end, {:.3g} "
               "rms, {:.3g} at most (the "
               "solution's own: {:.1g})\n",
               result.reference->times.count, result.reference->accuracy.final,
               result.reference->accuracy.l2, result.reference->accuracy.max,
               result.reference->error);
  print_balance(result);
  if (result.energy_drift) fmt::print("energy drift {:.3g}\n", *result.energy_drift);
  if (result.ranks.ranks > 1)
    fmt::print("{:.4g} messages and {:.4g} bytes a step, {:.1f} % of the time in exchanges, "
               "imbalance {:.3f}\n",
               result.messages_per_step, result.bytes_per_step, 100 * result.communication_share,
               result.ranks.imbalance);
  if (!result.ranks.halo_reason.empty())
    fmt::print("halo {}: {}\n", result.ranks.halo, result.ranks.halo_reason);
  for (const std::string& file : result.files) fmt::print("wrote {}\n", file);
}

/// Reports all mistakes that can be found without ranks before any rank is started.
void require_startable(RunRequest request) {
  request.is_model_auto = true;
  const RunPlan plan = plan_run(request);
  if (request.ranks > most_ranks_here())
    throw InputError(fmt::format("--ranks {}: more than {} are too many for this machine; start "
                                 "them by mpirun and your hosts",
                                 request.ranks, most_ranks_here()));
  decomposition_for(plan.scene.problem, request.decomposition, request.ranks);
}

int run(const CLI::App& command, const RunArguments& arguments) {
  RunRequest request = arguments.request;
  request.overrides = parse_overrides(arguments.set);
  const std::string analysis = chosen_analysis(command, request, arguments.analysis);
  if (analysis != "dynamic") return run_analysis(analysis, request, arguments.analysis);
  // the user started mpirun
  if (job_rank().ranks > 1 && request.ranks == 1) request.ranks = job_rank().ranks;
  if (request.ranks > 1 && !job_rank().is_started) {
    require_startable(request);
    return run_on_ranks(request.ranks, request.threads);
  }
  request.is_root = job_rank().is_root();
  request.is_model_auto = true;
  const RunResult result = run_scene(request);
  if (!request.json.empty() && request.is_root) write_json(request.json, run_json(request, result));
  if (result.status == "unstable") throw UnstableError(result.reason);
  if (request.json != "-" && result.status != "bound") print_summary(result);
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
  add_check_options(*command, request);
  command->footer("Example: dssbench run plate_paper --set n=100 --steps 500 --variant avx2 "
                  "--threads 2 --output plate.vtu");
  add_analysis_options(*command, arguments->analysis);
  command->callback([arguments, command, &chosen] {
    chosen = [arguments, command] { return run(*command, *arguments); };
  });
}

} // namespace dss
