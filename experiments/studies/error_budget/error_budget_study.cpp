#include "experiments/studies/error_budget/error_budget_study.hpp"
#include "experiments/measure/solution_rule.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/run/plan/names.hpp"
#include "kernels/model.hpp"
#include "solver/error.hpp"
#include "solver/scene/method_name.hpp"

#include <algorithm>

namespace dss {
namespace {

void read_refinement(const Node& node, BudgetScene& budget) {
  ObjectNode object(node);
  budget.refined = object.require("keeps").name();
  budget.is_one_body = object.flag_or("one_body", budget.is_one_body);
  budget.ratio = object.positive_or("ratio", budget.ratio);
  if (!(budget.ratio > 1))
    object.require("ratio").fail(
        fmt::format("{} is not above 1: each grid is finer than the one before", budget.ratio));
  const Node grids = object.require("grids");
  object.finish();
  for (const Node& grid : grids.items()) budget.refinement.push_back(one_set(grid));
  if (budget.refinement.size() != 3) grids.fail("an observed order needs three grids");
}

/// Rejects impossible scenes before any run starts.
void require_loadable(BudgetScene& budget) {
  const Scene scene = load_scene(budget.scene, budget.set);
  if (budget.integrator.empty()) budget.integrator = scene.integrator;
  if (budget.dt == 0) budget.dt = scene.problem.dt;
  budget.times.whole_steps_between(budget.dt);
  if (!budget.refinement.empty() && scene.problem.loads.empty())
    throw InputError(
        "refinement: the scene has no load, whose elements' displacement would be compared");
  for (const std::vector<Override>& grid : budget.refinement) {
    std::vector<Override> set = budget.set;
    set.insert(set.end(), grid.begin(), grid.end());
    load_scene(budget.scene, set);
  }
}

BudgetScene read_scene(const Node& node, double shorten) {
  ObjectNode object(node);
  BudgetScene budget;
  budget.scene = object.require("scene").name();
  budget.label = object.name_or("label", budget.scene);
  budget.variant = object.name_or("variant", "auto");
  budget.set = one_set(object, "set");
  if (const auto integrator = object.find("integrator"))
    budget.integrator = method_name_in(*integrator);
  budget.dt = object.positive_or("dt", 0);
  budget.times = read_saved_times(object, shorten);
  budget.precisions = object.known_names_or("precisions", "precision", names_of("PRECISION"), {});
  budget.models = object.known_names_or("models", "model", model_names(), {});
  budget.rotations = object.known_names_or("rotations", "rotation", names_of("ROTATION"), {});
  if (const auto refinement = object.find("refinement")) read_refinement(*refinement, budget);
  object.finish();
  node.placed([&] { require_loadable(budget); });
  return budget;
}

} // namespace

ErrorBudgetStudy read_error_budget(const StudyFile& file) {
  ObjectNode scale(file.scale), object(file.part("error_budget"));
  const double shorten = scale.positive_or("shorten", 1);
  const std::vector<std::string> chosen = scale.names_or("scenes", {});
  scale.finish();
  ErrorBudgetStudy budget{file.name, file.title, file.scale_name, {}, {}};
  budget.solution = read_solution_rule(object);
  const Node scenes = object.require("scenes");
  object.finish();
  for (const Node& item : scenes.items(1)) {
    const BudgetScene scene = read_scene(item, shorten);
    if (chosen.empty() || std::ranges::find(chosen, scene.label) != chosen.end())
      budget.scenes.push_back(scene);
  }
  if (budget.scenes.empty())
    scale.require("scenes").fail("no scene of the study has one of these labels");
  return budget;
}

} // namespace dss
