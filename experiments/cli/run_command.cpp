#include "experiments/base/interrupt.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"
#include "experiments/cli/run_summary.hpp"
#include "experiments/run/checkpoint/checkpoint.hpp"
#include "experiments/run/ensemble/ensemble_plan.hpp"
#include "experiments/run/ensemble/ensemble_run.hpp"
#include "experiments/run/guard/guard.hpp"
#include "experiments/run/plan/job.hpp"
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
#include <memory>

namespace dss {
namespace {

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
    files.write_members("--picture", request.picture);
    files.write_members("--history", request.history);
    files.write_members("--output", request.output);
    if (request.frames > 0 && request.output.ends_with(".vtu"))
      files.write_members("--output",
                          std::filesystem::path(request.output).replace_extension(".pvd").string());
  } else {
    files.write("--state", request.state_csv);
    files.write("--picture", request.picture);
    files.write("--history", request.history);
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
  if (command.count("--history") > 0 && request.history.empty())
    throw InputError("--history: its name is empty; give a file");
  if (command.count("--every") > 0 && request.every < 1)
    throw InputError(fmt::format("--every {}: give 1 step or more", request.every));
  if (request.history.empty() && (!request.probes.empty() || request.every > 0))
    request.history = "history.csv";
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
  FileSet outputs;
  const RunResult result = run_scene(request, outputs);
  if (request.is_root) write_json(outputs, request.json, run_json(request, result));
  if (result.status == "unstable") throw UnstableError(result.reason);
  const bool has_end = result.status == "ok" || result.status == "wrong";
  if (request.json != "-" && has_end) print_summary(result);
  if (result.status == "ok") return exit_success;
  fmt::print(stderr, "dssbench: {}: {}\n", result.scene, result.reason);
  return exit_check_failed;
}

} // namespace

void add_run_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("run", "Run one scene on one variant, and write the requested files");
  const auto arguments = std::make_shared<RunArguments>();
  add_run_options(*command, *arguments);
  command->footer("Example: dssbench run plate_paper --set n=100 --steps 500 --variant avx2 "
                  "--threads 2 --output plate.vtu");
  command->callback([arguments, command, &chosen] {
    chosen = [arguments, command] { return run(*command, *arguments); };
  });
}

} // namespace dss
