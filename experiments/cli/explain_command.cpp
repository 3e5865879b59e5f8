#include "experiments/base/text_table.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run/model/link_summary.hpp"
#include "experiments/run/model/model_choice.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "experiments/run/timed/output.hpp"
#include "solver/model/sufficiency/needs.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/model/thickness.hpp"
#include "solver/scene/scene.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace dss {
namespace {

struct ExplainArguments {
  std::string scene, json, precision = "f64";
  std::vector<std::string> set;
  std::optional<double> model_tolerance;
};

/// How the chosen model describes rotations.
Need rotations_of(const ModelChoice& choice) {
  const Model model = choice.chosen;
  const bool is_small = has_rotation_vectors(model);
  const int rotations = degrees_of(model) & (dof_rx | dof_ry | dof_rz);
  if (rotations == 0 || (is_small && !choice.is_bounded))
    return {"rotations", false, "nothing turns"};
  if (!is_small && is_of_plane(model))
    return {"rotations", true, "finite, about z alone: one angle as a pair of numbers, exact"};
  if (!is_small) return {"rotations", true, "finite, about any axis: quaternions"};
  return {"rotations", true,
          fmt::format("vectors, as long as the bound of their error stays below {:g}: rotations of "
                      "so many rad at most",
                      bounded_share * choice.tolerance)};
}

nlohmann::ordered_json needs_json(const std::vector<Need>& needs) {
  nlohmann::ordered_json json;
  for (const Need& item : needs)
    json[item.name] = {{"is_needed", item.is_needed}, {"why", item.why}};
  return json;
}

void print_needs(const char* title, const std::vector<Need>& needs) {
  std::vector<std::vector<std::string>> rows;
  for (const Need& item : needs)
    rows.push_back({item.name, item.is_needed ? "needed" : "not needed", item.why});
  fmt::print("\n{}", text_table({title, "", "why"}, rows));
}

void print_models(const ModelChoice& choice, const std::string& scene_model) {
  fmt::print("\nmodel {}: {}\n", name(choice.chosen), choice.why);
  for (const auto& [model, reason] : choice.smaller)
    fmt::print("  not {}: {}\n", name(model), reason);
  if (scene_model != "auto")
    fmt::print("  the scene names {}, which `run` takes unless --model auto is given\n",
               scene_model);
}

/// Of each load.
std::vector<std::size_t> loaded_elements(const Problem& problem) {
  std::vector<std::size_t> counts;
  for (const Load& load : problem.loads) counts.push_back(load.elements.size());
  return counts;
}

/// How many elements the selections of clamps and loads have.
std::string selections_text(const Problem& problem) {
  constexpr std::size_t most = 12; // a load along a line is one for each element
  std::string text = fmt::format("clamps hold {} elements", problem.clamps.size());
  const std::vector<std::size_t> counts = loaded_elements(problem);
  if (counts.empty()) return text + "; nothing is loaded\n";
  const auto end = counts.begin() + std::ptrdiff_t(std::min(most, counts.size()));
  return text + fmt::format("; loads act on {}{} elements\n", fmt::join(counts.begin(), end, ", "),
                            end == counts.end() ? "" : ", ...");
}

int explain(const ExplainArguments& arguments) {
  const std::vector<Override> overrides = parse_overrides(arguments.set);
  require_sound_output(arguments.scene, overrides, arguments.json);
  const Scene scene = load_scene(arguments.scene, overrides);
  const Problem& problem = scene.problem;
  const auto precision = require_precision_name(arguments.precision);
  const double tolerance = require_model_tolerance(arguments.model_tolerance.value_or(
      (is_single(precision) ? problem.tolerance_f32 : problem.tolerance_f64).run));
  const ModelChoice choice =
      choose_model(problem, tolerance, why_no_watch(require_method(problem.integrator)));
  const std::vector<Need> dofs = degrees_of_freedom(problem, choice.chosen),
                          needed_terms = terms(problem, choice.chosen),
                          rotations{rotations_of(choice)};
  const std::vector<LinkSummary> links = summarize_links(problem);
  const std::vector<PressureSummary> pressures = summarize_pressures(problem);
  const std::vector<std::string> notes = softness_notes(problem);
  if (!arguments.json.empty()) {
    nlohmann::ordered_json smaller = nlohmann::ordered_json::object();
    for (const auto& [model, reason] : choice.smaller) smaller[std::string(name(model))] = reason;
    write_json(arguments.json, {{"scene", scene.name},
                                {"elements", problem.lattice.element_count},
                                {"links", problem.link_count()},
                                {"model", name(choice.chosen)},
                                {"why", choice.why},
                                {"is_proven", !choice.is_bounded},
                                {"tolerance", tolerance},
                                {"smaller", smaller},
                                {"degrees_of_freedom", needs_json(dofs)},
                                {"terms", needs_json(needed_terms)},
                                {"rotations", needs_json(rotations)},
                                {"clamped_elements", problem.clamps.size()},
                                {"loaded_elements", loaded_elements(problem)},
                                {"links_by_kind", links_json(links)},
                                {"pressures", pressures_json(pressures)},
                                {"notes", notes}});
  }
  if (arguments.json == "-") return exit_success;
  fmt::print("{}: {}\n{} elements, {} links, tolerance {:g} of a run in {}\n", scene.name,
             scene.title, problem.lattice.element_count, problem.link_count(), tolerance,
             arguments.precision);
  print_models(choice, scene.asked_model);
  print_needs("degree of freedom", dofs);
  print_needs("term", needed_terms);
  print_needs("", rotations);
  fmt::print("\n{}", selections_text(problem));
  fmt::print("\n{}", links_text(links));
  if (!pressures.empty()) fmt::print("\n{}", pressures_text(pressures));
  for (const std::string& note : notes) fmt::print("\nnote: {}\n", note);
  return exit_success;
}

} // namespace

void add_explain_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("explain", "Explain which degrees of freedom, terms and rotations a scene "
                                    "needs, why it does not need the others, and which constants "
                                    "its links have");
  const auto arguments = std::make_shared<ExplainArguments>();
  command->add_option("SCENE", arguments->scene, "A name from `dssbench list scenes`, or a path")
      ->required();
  command
      ->add_option("--set", arguments->set,
                   "Override a parameter or any number of the scene; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command
      ->add_option("--precision", arguments->precision,
                   "f64, f32 or f32c: the precision whose tolerance is used")
      ->type_name("PRECISION")
      ->capture_default_str();
  command->add_option("--model-tolerance", arguments->model_tolerance,
                      "Largest relative error of a model of small rotations (default: the scene's "
                      "tolerance of a run)");
  command->add_option("--json", arguments->json, "File for the result, or - for standard output");
  command->footer("Example: dssbench explain plate_paper --set n=20");
  command->callback([arguments, &chosen] { chosen = [arguments] { return explain(*arguments); }; });
}

} // namespace dss
