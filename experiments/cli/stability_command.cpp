#include "experiments/base/text_table.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/stability/stability_limit.hpp"
#include "variants/isa/denormals.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace dss {
namespace {

struct StabilityArguments {
  std::string scene, integrator, variant = "auto", json;
  std::vector<std::string> set;
  bool is_predicted_only = false;
};

std::vector<const Method*> chosen_methods(const StabilityArguments& arguments, const Scene& scene) {
  if (arguments.integrator != "all")
    return {&require_method(arguments.integrator.empty() ? scene.problem.integrator
                                                         : arguments.integrator)};
  std::vector<const Method*> all;
  for (const Method& method : methods()) all.push_back(&method);
  return all;
}

std::string why_not_measured(const StabilityArguments& arguments, const Scene& scene) {
  if (arguments.is_predicted_only) return "--predict";
  if (scene.problem.lattice.element_count > sharp_stability_elements)
    return fmt::format("more than {} elements", sharp_stability_elements);
  return "";
}

std::vector<LimitComparison> comparisons(const StabilityArguments& arguments, const Scene& scene) {
  const Plugin& plugin = load_variant(arguments.variant);
  require_terms(plugin, scene.problem);
  const std::string why_not = why_not_measured(arguments, scene);
  const std::vector<const Method*> chosen = chosen_methods(arguments, scene);
  const std::vector<StabilityLimit> predicted = stable_steps(scene.problem, chosen);
  std::vector<LimitComparison> rows;
  for (std::size_t m = 0; m < chosen.size(); ++m)
    rows.push_back(why_not.empty() ? compare_limit(plugin, scene.problem, *chosen[m], predicted[m])
                                   : predicted_alone(*chosen[m], predicted[m], why_not));
  return rows;
}

nlohmann::ordered_json limit_json(const LimitComparison& row) {
  using LimitJson = nlohmann::ordered_json;
  const auto number = [](double value, bool is_there = true) {
    return is_there && std::isfinite(value) ? LimitJson(value) : LimitJson();
  };
  const bool is_measured = row.measured.runs > 0;
  return {{"integrator", std::string(row.method->name)},
          {"predicted_dt_s", number(row.predicted.dt)},
          {"measured_dt_s", number(row.measured.dt, is_measured)},
          {"ratio", number(row.ratio(), is_measured)},
          {"is_exact", row.predicted.is_exact},
          {"prediction", row.predicted.how},
          {"mode", mode_text(row.predicted)},
          {"mode_omega_rad_per_s", row.predicted.mode.omega},
          {"mode_rate_per_s", row.predicted.mode.rate},
          {"omega_max_rad_per_s", row.predicted.omega_max},
          {"damping_max_per_s", row.predicted.damping},
          {"steps", row.measured.steps},
          {"runs", row.measured.runs},
          {"status", row.status},
          {"reason", row.reason}};
}

void print_one(const Scene& scene, const StabilityArguments& arguments,
               const LimitComparison& row) {
  const StabilityLimit& limit = row.predicted;
  const std::string share =
      limit.dt > 0 ? fmt::format(" ({:.3g} of the limit)", scene.problem.dt / limit.dt) : "";
  fmt::print("{}: {} is predicted stable up to dt = {:.6g} s; the scene's step is {:.6g} s{}\n",
             scene.name, row.method->name, limit.dt, scene.problem.dt, share);
  fmt::print("largest frequency {:.6g} rad/s, largest damping rate {:.6g} 1/s; {}\n",
             limit.omega_max, limit.damping, limit.how);
  if (std::isfinite(limit.dt)) fmt::print("limited by {}\n", mode_text(limit));
  const std::string reason = row.reason.empty() ? "" : ": " + row.reason;
  if (row.measured.runs == 0)
    fmt::print("{}{}\n", row.status, reason);
  else
    fmt::print("measured with {}: dt = {:.6g} s{} ({} runs of {} steps); {}{}\n",
               load_variant(arguments.variant).name, row.measured.dt,
               limit.dt > 0 ? fmt::format(", {:.4f} of the prediction", row.ratio()) : "",
               row.measured.runs, row.measured.steps, row.status, reason);
}

void print_all(const Scene& scene, const StabilityArguments& arguments,
               const std::vector<LimitComparison>& rows) {
  std::vector<std::vector<std::string>> lines;
  for (const LimitComparison& row : rows) {
    const bool is_measured = row.measured.runs > 0;
    lines.push_back({std::string(row.method->name), fmt::format("{:.6g}", row.predicted.dt),
                     is_measured ? fmt::format("{:.6g}", row.measured.dt) : "",
                     is_measured && row.predicted.dt > 0 ? fmt::format("{:.4f}", row.ratio()) : "",
                     mode_text(row.predicted), row.status, row.reason});
  }
  fmt::print("{}: {} elements, the scene's step is {:.6g} s; measured with {}; {}\n{}", scene.name,
             scene.problem.lattice.element_count, scene.problem.dt,
             load_variant(arguments.variant).name, rows[0].predicted.how,
             text_table({"integrator", "predicted [s]", "measured [s]", "ratio", "limited by",
                         "status", "reason"},
                        lines));
}

int stability(const StabilityArguments& arguments) {
  const std::vector<Override> overrides = parse_overrides(arguments.set);
  require_sound_output(arguments.scene, overrides, arguments.json);
  const Scene scene = load_scene(arguments.scene, overrides);
  flush_denormals();
  const std::vector<LimitComparison> rows = comparisons(arguments, scene);
  if (!arguments.json.empty()) {
    nlohmann::ordered_json json = {{"scene", scene.name},
                                   {"elements", scene.problem.lattice.element_count},
                                   {"dt_s", scene.problem.dt},
                                   {"variant", load_variant(arguments.variant).name},
                                   {"limits", nlohmann::ordered_json::array()}};
    for (const LimitComparison& row : rows) json["limits"].push_back(limit_json(row));
    write_json(arguments.json, json);
  }
  if (arguments.json != "-" && rows.size() == 1) print_one(scene, arguments, rows[0]);
  if (arguments.json != "-" && rows.size() > 1) print_all(scene, arguments, rows);
  const bool has_failed = std::ranges::count(rows, "failed", &LimitComparison::status) > 0;
  return has_failed ? exit_check_failed : exit_success;
}

} // namespace

void add_stability_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "stability", "Predict the largest stable step of a scene, and measure it by runs about rest");
  const auto arguments = std::make_shared<StabilityArguments>();
  command->add_option("SCENE", arguments->scene, "A name from `dssbench list scenes`, or a path")
      ->required();
  command
      ->add_option("--integrator", arguments->integrator,
                   fmt::format("{}; all: every explicit method (default: the scene's)",
                               fmt::join(method_names(), ", ")))
      ->type_name("INTEGRATOR");
  command
      ->add_option("--variant", arguments->variant,
                   "A name from `dssbench list variants`; auto: the fastest here")
      ->capture_default_str()
      ->type_name("VARIANT");
  command
      ->add_option("--set", arguments->set,
                   "Override a parameter or any number of the scene; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_flag("--predict", arguments->is_predicted_only, "Only predict; measure nothing");
  command->add_option("--json", arguments->json, "File for the result, or - for standard output");
  command->footer("Example: dssbench stability plate_paper --set n=10 --integrator all\nExit code "
                  "1 if a measured limit differs from an exact prediction by more than 1 %.");
  command->callback(
      [arguments, &chosen] { chosen = [arguments] { return stability(*arguments); }; });
}

} // namespace dss
