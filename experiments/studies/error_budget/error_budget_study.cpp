#include "experiments/studies/error_budget/error_budget_study.hpp"
#include "experiments/measure/solution_rule.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/run/plan/run_plan.hpp"

#include <algorithm>

namespace dss {
namespace {

std::vector<std::string> texts_if(const JsonPlace& place, const char* key) {
  return place.has(key) ? place[key].texts() : std::vector<std::string>{};
}

void read_refinement(const JsonPlace& place, BudgetScene& budget) {
  place.require_keys({"grids", "ratio", "keeps", "one_body"});
  budget.refined = place["keeps"].text();
  if (place.has("one_body")) budget.is_one_body = place["one_body"].flag();
  if (place.has("ratio")) budget.ratio = place["ratio"].positive();
  if (!(budget.ratio > 1))
    place["ratio"].fail("is not above 1: each grid is finer than the one before");
  for (const JsonPlace& grid : place["grids"].items()) budget.refinement.push_back(one_set(grid));
  if (budget.refinement.size() != 3) place["grids"].fail("an observed order needs three grids");
}

/// Rejects impossible scenes before any run starts.
void require_loadable(const JsonPlace& place, BudgetScene& budget) {
  try {
    const Scene scene = load_scene(budget.scene, budget.set);
    budget.integrator = std::string(
        require_method(budget.integrator.empty() ? scene.integrator : budget.integrator).name);
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
  } catch (const InputError& error) {
    place.fail(error.what());
  }
}

BudgetScene read_scene(const JsonPlace& place, double shorten) {
  place.require_keys({"label", "scene", "set", "variant", "integrator", "dt", "end_time",
                      "saved_times", "refinement", "precisions", "models", "rotations"});
  BudgetScene budget;
  budget.scene = place["scene"].text();
  budget.label = place.has("label") ? place["label"].text() : budget.scene;
  budget.variant = place.has("variant") ? place["variant"].text() : "auto";
  if (place.has("set")) budget.set = one_set(place["set"]);
  if (place.has("integrator")) budget.integrator = place["integrator"].text();
  if (place.has("dt")) budget.dt = place["dt"].positive();
  budget.times = read_saved_times(place, shorten);
  budget.precisions = texts_if(place, "precisions");
  budget.models = texts_if(place, "models");
  budget.rotations = texts_if(place, "rotations");
  if (place.has("refinement")) read_refinement(place["refinement"], budget);
  require_loadable(place, budget);
  return budget;
}

} // namespace

ErrorBudgetStudy read_error_budget(const StudyFile& file) {
  const JsonPlace &scale_place = file.scale, &place = file.root["error_budget"];
  scale_place.require_keys({"shorten", "scenes"});
  const double shorten = scale_place.has("shorten") ? scale_place["shorten"].positive() : 1;
  const std::vector<std::string> chosen = texts_if(scale_place, "scenes");
  place.require_keys({"solution", "scenes"});
  ErrorBudgetStudy budget{file.name, file.title, file.scale_name, {}, {}};
  if (place.has("solution")) budget.solution = read_solution_rule(place["solution"]);
  for (const JsonPlace& item : place["scenes"].items()) {
    const BudgetScene scene = read_scene(item, shorten);
    if (chosen.empty() || std::ranges::find(chosen, scene.label) != chosen.end())
      budget.scenes.push_back(scene);
  }
  if (budget.scenes.empty())
    scale_place["scenes"].fail("no scene of the study has one of these labels");
  return budget;
}

} // namespace dss
