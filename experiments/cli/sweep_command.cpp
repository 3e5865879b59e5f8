#include "experiments/base/child.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/sweep_study.hpp"
#include "experiments/measure/cell_plan.hpp"
#include "experiments/measure/study_paths.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/studies/run_study.hpp"
#include "experiments/studies/speedup/speedup_study.hpp"
#include "solver/cores.hpp"
#include "solver/error.hpp"
#include "solver/io/program_files.hpp"
#include "solver/json/parse.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>

namespace dss {
namespace {

namespace fs = std::filesystem;

struct SweepArguments {
  SweepRequest request;
  std::string directory = "sweeps";
  bool resumes = false, is_dry = false, has_picture = true;
};

/// A new study, with as many steps as the samples need. Nothing is written unless it is sound.
void make_study(const SweepRequest& request, const std::string& path) {
  if (fs::exists(path))
    throw InputError(fmt::format("{}: this sweep is there; give --resume to go on with it, or "
                                 "another --name or --out",
                                 path));
  nlohmann::ordered_json study = sweep_study(request, {});
  const SpeedupStudy cells = read_speedup(sweep_file(study), usable_cores());
  if (request.steps == 0) {
    Progress progress;
    study = sweep_study(request, trial_rates(cells, progress));
  }
  write_json(path, study);
}

/// Prints what a sweep would measure. Nothing runs, and nothing is written.
int show_plan(const SweepRequest& request, const std::string& directory, const std::string& name) {
  const SpeedupStudy cells = read_speedup(sweep_file(sweep_study(request, {})), usable_cores());
  fmt::print("{}", plan_text(cells, study_paths(directory, name)));
  if (request.steps == 0)
    fmt::print("Steps: a trial finds how many a sample of {:g} s needs; the plan shows the least "
               "number.\n",
               request.sample_s);
  return exit_success;
}

/// Requires that the study that is there has the cells of the request.
void require_same(const SweepRequest& request, const std::string& path) {
  if (!fs::exists(path))
    throw InputError(fmt::format("--resume: there is no {}; begin the sweep without it", path));
  const nlohmann::json there = parse_json_file(path), asked = sweep_study(request, {});
  const auto differs = [&](const char* key) {
    return there.value(key, nlohmann::json()) != asked.at(key);
  };
  if (differs("cells") || differs("base"))
    throw InputError(fmt::format("--resume: {} is a sweep of other choices; give those, or another "
                                 "--name or --out",
                                 path));
}

/// Draws the figures of a study, if the program's plots are there. A fault costs only the figures.
void draw(const std::string& directory, const std::string& name) {
  constexpr double limit_s = 120;
  const fs::path plots = program_file("plots/make_plots.py");
  if (!fs::exists(plots)) {
    fmt::print("Pictures: plots/make_plots.py --results {} of the source tree draws them\n",
               directory);
    return;
  }
  try {
    const ChildResult drawn =
        run_child("/usr/bin/python3",
                  {"python3", plots.string(), "--results", directory, "--table", name}, limit_s);
    fmt::print("{}", drawn.output);
    if (drawn.exit_code == 0) return;
    std::string last = drawn.error;
    while (last.ends_with('\n')) last.pop_back();
    last = last.substr(last.find_last_of('\n') + 1);
    fmt::print(stderr, "dssbench: sweep: no picture: {}\n",
               last.empty() ? drawn.failure(limit_s) : last);
  } catch (const InputError& fault) {
    fmt::print(stderr, "dssbench: sweep: no picture: {}\n", fault.what());
  }
}

int sweep(const SweepArguments& arguments) {
  const SweepRequest& request = arguments.request;
  const std::string name = sweep_name(request),
                    path = (fs::path(arguments.directory) / (name + ".json")).string();
  if (arguments.is_dry) return show_plan(request, arguments.directory, name);
  if (arguments.resumes) {
    require_same(request, path);
  } else {
    make_directories(study_paths(arguments.directory, name));
    make_study(request, path);
  }
  StudyOptions options;
  options.scale = sweep_scale;
  options.directory = arguments.directory;
  options.resumes = arguments.resumes;
  const int code = run_study_file(path, options);
  fmt::print("Study: {}\n", path);
  if (arguments.has_picture) draw(arguments.directory, name);
  return code;
}

/// Options that say which cells there are.
void add_cells(CLI::App& command, SweepRequest& request) {
  const auto list = [&](const char* option, std::vector<std::string>& values, const char* type,
                        const std::string& text) {
    command.add_option(option, values, text)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name(type);
  };
  command
      .add_option("--set", request.set,
                  "A parameter or number of the scene, and its values; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE,...");
  list("--variant", request.variants, "VARIANT", "Names from `dssbench list variants`");
  command.get_option("--variant")->required();
  list("--threads", request.threads, "TEXT",
       "Numbers, or cores, rest (all but one), 1..cores, fill (as many as ranks leave)");
  list("--ranks", request.ranks, "TEXT", "Numbers of processes");
  list("--halo", request.halos, "HALO",
       fmt::format("On several ranks: {}", fmt::join(names_of("HALO"), ", ")));
  list("--decomposition", request.decompositions, "DECOMPOSITION",
       fmt::format("On several ranks: {}", fmt::join(names_of("DECOMPOSITION"), ", ")));
  list("--ensemble", request.members, "TEXT",
       "Numbers of equal members that run side by side, as `dssbench run --ensemble N`");
  command
      .add_option("--device", request.device,
                  "Device for variants that compute on devices, as for `dssbench run --device`")
      ->type_name("DEVICE");
  list("--model", request.models, "MODEL", "Names of models (default: spatial)");
  list("--precision", request.precisions, "PRECISION", "f64, f32, f32c (default: f64)");
  list("--integrator", request.integrators, "INTEGRATOR", "Names of methods (default: rk4)");
  command
      .add_option("--base", request.base,
                  "Variant that speed-ups refer to, on one thread (default: the first one)")
      ->type_name("VARIANT");
}

/// Options that say how much is measured, and where it goes.
void add_effort(CLI::App& command, SweepArguments& arguments) {
  SweepRequest& request = arguments.request;
  command
      .add_option("--steps", request.steps,
                  "Steps of every cell (default: as many as --sample-time needs, found by a trial)")
      ->check(CLI::Range(2L, 1L << 40));
  command.add_option("--sample-time", request.sample_s, "Least time of a sample [s]")
      ->capture_default_str();
  command
      .add_option("--repetitions", request.repetitions,
                  "Least number of repetitions of a cell; six give an interval")
      ->capture_default_str()
      ->check(CLI::Range(1L, 1000L));
  command
      .add_option("--budget", request.budget_s,
                  "No repetitions beyond the least number after this time [s]")
      ->capture_default_str();
  command.add_option("--name", request.name, "Name of the study (default: sweep_SCENE)");
  command
      .add_option("--out", arguments.directory, "Directory of the study, raw/, tables/, figures/")
      ->capture_default_str();
  command.add_flag(
      "--resume", arguments.resumes,
      "Go on with the study that is there, as it is, and measure only what is missing");
  command.add_flag("--dry-run", arguments.is_dry, "Print the plan and measure nothing")
      ->excludes("--resume");
  command.add_flag("!--no-picture", arguments.has_picture, "Draw nothing");
}

} // namespace

void add_sweep_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "sweep", "Measure every combination of some choices, interleaved, checked, with intervals");
  const auto arguments = std::make_shared<SweepArguments>();
  command
      ->add_option("SCENE", arguments->request.scene,
                   "A name from `dssbench list scenes`, or a path")
      ->required();
  add_cells(*command, arguments->request);
  add_effort(*command, *arguments);
  command->footer("Example: dssbench sweep plate_paper --set n=40,80 --variant scalar,avx2 "
                  "--threads 1,cores\nExit code 1 if a cell failed or was wrong.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return sweep(*arguments); }; });
}

} // namespace dss
