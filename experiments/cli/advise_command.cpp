#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run/advise/advice_text.hpp"
#include "experiments/run/advise/advise.hpp"
#include "experiments/run/advise/grid_advice.hpp"
#include "experiments/run/plan/names.hpp"
#include "solver/cores.hpp"
#include "solver/error.hpp"
#include "solver/nearest_name.hpp"

#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct AdviseArguments {
  std::string scene, quantity = "displacement", json, vary;
  std::vector<std::string> set;
  AdviseRequest request;
  std::optional<double> end;
  long saved_times = 10;
  int threads = 0; ///< 0: all cores
  bool is_verbose = false;
};

AdviseRequest checked_request(const AdviseArguments& arguments) {
  AdviseRequest request = arguments.request;
  const auto quantity = find_quantity(arguments.quantity);
  if (!quantity)
    throw InputError(fmt::format("--quantity {}: unknown quantity; {}", arguments.quantity,
                                 nearest_name(arguments.quantity, names_of("QUANTITY"))));
  request.quantity = *quantity;
  if (arguments.threads < 0 || arguments.threads > 1024)
    throw InputError(fmt::format("--threads {}: give 1 to 1024", arguments.threads));
  request.most_threads = arguments.threads == 0 ? usable_cores() : arguments.threads;
  if (request.budget_s && !(*request.budget_s > 0))
    throw InputError(fmt::format("--budget {:g}: give a positive time [s]", *request.budget_s));
  return request;
}

SavedTimes checked_times(const AdviseArguments& arguments, const Problem& problem) {
  const double end = arguments.end.value_or(problem.dt * double(problem.steps));
  if (!(end > 0) || !std::isfinite(end))
    throw InputError(fmt::format("--end {:g}: give a positive time [s]", end));
  if (arguments.saved_times < 1)
    throw InputError(fmt::format("--saved-times {}: give at least 1", arguments.saved_times));
  return {end, arguments.saved_times};
}

/// Chooses the grid if --vary names a parameter. The run gets the rest of the tolerance.
/// @return nothing without --vary
std::optional<GridAdvice> grid_for(const AdviseArguments& arguments, const SavedTimes& times,
                                   AdviseRequest& request, std::vector<Override>& overrides,
                                   const std::function<void(const std::string&)>& note) {
  if (arguments.vary.empty()) return {};
  GridAdvice grid = advise_grid(arguments.scene, overrides, arguments.vary, times, request, note);
  if (!grid.failure.empty()) return grid;
  overrides.push_back({arguments.vary, fmt::format("{}", grid.value)});
  request.tolerance -= grid.error;
  return grid;
}

int fail_check(const std::string& scene, const std::string& failure) {
  fmt::print(stderr, "dssbench: {}: {}\n", scene, failure);
  return exit_check_failed;
}

int advise_scene(const AdviseArguments& arguments) {
  AdviseRequest request = checked_request(arguments);
  std::vector<Override> overrides = parse_overrides(arguments.set);
  require_sound_output(arguments.scene, overrides, arguments.json);
  const auto note = [&](const std::string& what) {
    if (arguments.is_verbose) fmt::print(stderr, "{}\n", what);
  };
  const SavedTimes times = checked_times(arguments, load_scene(arguments.scene, overrides).problem);
  const std::optional<GridAdvice> grid = grid_for(arguments, times, request, overrides, note);
  if (grid && !grid->failure.empty()) return fail_check(arguments.scene, grid->failure);
  const Scene scene = load_scene(arguments.scene, overrides);
  AdvisedScene advised{arguments.scene, "", scene.name, scene.problem.lattice.element_count};
  for (const Override& set : overrides)
    advised.set += fmt::format(" --set {}={}", set.key, set.value);
  const Advice advice = advise(scene.problem, times, request, note);
  const Workbench bench(scene.problem, times, request.quantity);
  if (!arguments.json.empty()) {
    nlohmann::ordered_json json = advice_json(advised, request, bench, advice);
    if (grid) json["grid"] = grid_json(arguments.vary, *grid);
    write_json(arguments.json, json);
  }
  if (arguments.json != "-" && grid) fmt::print("{}", grid_text(arguments.vary, *grid));
  if (arguments.json != "-")
    fmt::print("{}", advice_text(advised, request, bench, advice, arguments.is_verbose));
  return advice.failure.empty() ? exit_success : fail_check(scene.name, advice.failure);
}

} // namespace

void add_advise_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("advise", "Find the cheapest model, integrator, precision, step, variant "
                                   "and threads that keep a scene within a tolerance");
  const auto arguments = std::make_shared<AdviseArguments>();
  AdviseRequest& request = arguments->request;
  command->add_option("SCENE", arguments->scene, "A name from `dssbench list scenes`, or a path")
      ->required();
  command
      ->add_option(
          "--tolerance", request.tolerance,
          "Largest allowed error against the exact solution in time, on the scene's own grid")
      ->required();
  command
      ->add_option("--quantity", arguments->quantity,
                   fmt::format("displacement: {}; stress: {}; energy: {}",
                               measure_of(Quantity::displacement), measure_of(Quantity::stress),
                               measure_of(Quantity::energy)))
      ->capture_default_str()
      ->type_name("QUANTITY");
  command
      ->add_option("--set", arguments->set,
                   "Override a parameter or any number of the scene; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_option(
      "--vary", arguments->vary,
      "Also choose the grid: the name of a scene parameter that refines it. The grid gets half of "
      "the tolerance; its error is estimated by Richardson extrapolation over three grids "
      "(default: keep the scene's grid and count only errors in time)");
  command->add_option("--end", arguments->end,
                      "End of the run [s] (default: that of the scene's steps)");
  command
      ->add_option(
          "--saved-times", arguments->saved_times,
          "Number of equally spaced times at which errors are measured; the last is the end")
      ->capture_default_str();
  command
      ->add_option(
          "--variant", request.variants,
          "Variants to choose from, separated by commas (default: all that run on this CPU)")
      ->delimiter(',')
      ->type_name("VARIANT");
  command->add_option("--threads", arguments->threads,
                      "Largest number of threads to try (default: all cores)");
  command->add_option(
      "--budget", request.budget_s,
      fmt::format(
          "Time limit for all trials [s] (default: {:g} times the paper's run, at least {:g} s)",
          budget_share, least_budget_s));
  command->add_option("--json", arguments->json, "File for the advice, or - for standard output");
  command->add_flag("--verbose", arguments->is_verbose,
                    "Also list every candidate and why it was not chosen");
  command->footer("Example: dssbench advise cantilever_beam --tolerance 1e-4\nExit code 1 if "
                  "nothing meets the tolerance, or if no error can be estimated.");
  command->callback(
      [arguments, &chosen] { chosen = [arguments] { return advise_scene(*arguments); }; });
}

} // namespace dss
