#include "experiments/measure/solution_rule.hpp"
#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_sets.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/studies/advise/advise_study.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>

namespace dss {
namespace {

Quantity read_quantity(const JsonPlace& place) {
  const std::string text = place.text();
  if (const auto quantity = find_quantity(text)) return *quantity;
  place.fail(
      fmt::format("{}: unknown quantity; {}", text, nearest_name(text, names_of("QUANTITY"))));
}

AdviseStudy::Case read_case(const JsonPlace& place, double shorten, const std::string& file) {
  place.require_keys({"scene", "set", "end_time", "saved_times", "quantity"});
  AdviseStudy::Case of;
  of.scene = scene_beside(file, place["scene"].text());
  if (place.has("set")) of.set = one_set(place["set"]);
  if (place.has("quantity")) of.quantity = read_quantity(place["quantity"]);
  of.times = read_saved_times(place, shorten);
  try {
    of.loaded = load_scene(of.scene, of.set);
  } catch (const InputError& error) {
    place.fail(error.what());
  }
  return of;
}

std::vector<double> read_tolerances(const JsonPlace& place) {
  std::vector<double> tolerances;
  for (const JsonPlace& item : place.items()) tolerances.push_back(item.positive());
  if (tolerances.empty()) place.fail("is empty; give at least one tolerance, such as 1e-4");
  std::ranges::sort(tolerances, std::greater());
  return tolerances;
}

} // namespace

AdviseStudy read_advise(const StudyFile& file) {
  const JsonPlace &scale_place = file.scale, &place = file.root["advise"];
  scale_place.require_keys({"shorten", "tolerances", "scenes"});
  place.require_keys({"solution", "tolerances", "bar", "scenes"});
  AdviseStudy study;
  study.name = file.name;
  study.title = file.title;
  study.scale = file.scale_name;
  if (place.has("solution")) study.solution = read_solution_rule(place["solution"]);
  if (place.has("bar")) study.bar = place["bar"].positive();
  study.tolerances = read_tolerances(scale_place.has("tolerances") ? scale_place["tolerances"]
                                                                   : place["tolerances"]);
  const double shorten = scale_place.has("shorten") ? scale_place["shorten"].positive() : 1;
  const std::vector<std::string> chosen =
      scale_place.has("scenes") ? scale_place["scenes"].texts() : std::vector<std::string>{};
  for (const JsonPlace& item : place["scenes"].items())
    if (chosen.empty() || std::ranges::find(chosen, item["scene"].text()) != chosen.end())
      study.cases.push_back(read_case(item, shorten, file.path));
  if (study.cases.empty()) place["scenes"].fail("no scene is left");
  return study;
}

} // namespace dss
