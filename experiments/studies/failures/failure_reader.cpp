#include "experiments/measure/study_file.hpp"
#include "experiments/studies/failures/failure_case.hpp"
#include "solver/nearest_name.hpp"
#include "solver/scene/scene.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <regex>
#include <set>

namespace dss {
namespace {

template <class Named>
std::vector<std::string> names_in(const Named& all) {
  std::vector<std::string> names;
  for (const auto& one : all) names.emplace_back(one.name);
  return names;
}

std::vector<std::string> rotation_list() {
  std::vector<std::string> names;
  for (const Rotation rotation : rotations) names.emplace_back(name(rotation));
  return names;
}

std::string chosen(const JsonPlace& place, const std::vector<std::string>& known) {
  const std::string text = place.text();
  if (std::ranges::find(known, text) == known.end())
    place.fail(fmt::format("unknown \"{}\"; {}", text, nearest_name(text, known)));
  return text;
}

/// Reads a list of names; `otherwise` if the key is missing. "explicit" and "all" stand for groups
/// of methods.
std::vector<std::string> chosen_list(const JsonPlace& object, const char* key,
                                     const std::vector<std::string>& known,
                                     std::vector<std::string> otherwise) {
  if (!object.has(key)) return otherwise;
  std::vector<std::string> list;
  for (const JsonPlace& item : object[key].items()) {
    const bool is_group = std::string(key) == "methods" && item.value().is_string();
    if (is_group && item.text() == "explicit")
      for (const std::string& name : names_in(methods())) list.push_back(name);
    else if (is_group && item.text() == "all")
      list.insert(list.end(), known.begin(), known.end());
    else
      list.push_back(chosen(item, known));
  }
  if (list.empty()) object[key].fail("is empty; give at least one name");
  return list;
}

std::vector<std::string> precision_list() {
  std::vector<std::string> names;
  for (const char* text : {"f64", "f32", "f32c"}) // a build may have fewer precisions
    if (find_precision(text)) names.emplace_back(text);
  return names;
}

AtlasReference read_reference(const JsonPlace& place, const std::string& path) {
  AtlasReference reference;
  if (place.has("converged")) {
    place.require_keys({"converged", "scene", "base"});
    reference.converged = place["converged"].positive();
    if (place.has("scene")) reference.scene = scene_beside(path, place["scene"].text());
    if (place.has("base")) reference.base = std::size_t(place["base"].count(0));
    return reference;
  }
  const std::string name = chosen(place["closed_form"], names_in(closed_forms()));
  reference.form = &*std::ranges::find(closed_forms(), name, &ClosedForm::name);
  for (const auto& item : place.value().items())
    if (item.key() != "closed_form" &&
        std::ranges::find(reference.form->arguments, item.key()) == reference.form->arguments.end())
      place.fail(fmt::format("\"{}\" is not an argument of the closed form {}", item.key(), name));
  for (const char* argument : reference.form->arguments)
    reference.arguments.emplace(argument, Formula(place[argument]));
  return reference;
}

Expectation read_expectation(const JsonPlace& place) {
  place.require_keys(
      {"methods", "precisions", "rotations", "set", "verdict", "why", "predicted", "within"});
  Expectation expected;
  expected.methods = chosen_list(place, "methods", method_names(), {});
  expected.precisions = chosen_list(place, "precisions", precision_list(), {});
  expected.rotations = chosen_list(place, "rotations", rotation_list(), {});
  if (place.has("set")) expected.set = one_set(place["set"]);
  expected.verdict =
      chosen(place["verdict"], {std::begin(atlas_verdicts), std::end(atlas_verdicts)});
  expected.why = place["why"].text();
  if (place.has("predicted") != place.has("within"))
    place.fail("\"predicted\" and \"within\" go together: a figure and the relative deviation that "
               "is allowed");
  if (place.has("predicted")) {
    expected.predicted = Formula(place["predicted"]);
    expected.within = place["within"].positive();
    if (expected.verdict == "refused") place["predicted"].fail("what is refused has no figure");
  }
  return expected;
}

void read_question(const JsonPlace& place, FailureCase& atlas) {
  atlas.metric = chosen(place["metric"], atlas_metrics());
  const bool is_value = atlas.metric == "value";
  if (is_value) {
    const JsonPlace value = place["value"];
    value.require_keys({"field", "element", "scale"});
    atlas.field = chosen(value["field"], field_names());
    atlas.element = Formula(value["element"]);
    atlas.scale = Formula(value["scale"]);
  } else if (place.has("value")) {
    place["value"].fail("belongs to the metric \"value\"");
  }
  if (needs_reference(atlas.metric) != place.has("reference"))
    place.fail(fmt::format("the metric \"{}\" {} a \"reference\"", atlas.metric,
                           needs_reference(atlas.metric) ? "needs" : "does not take"));
  const JsonPlace ok = place["ok"];
  ok.require_keys({"below", "at_least"});
  if (ok.has("below")) atlas.ok_below = Formula(ok["below"]);
  if (ok.has("at_least")) atlas.ok_at_least = Formula(ok["at_least"]);
  if (!atlas.ok_below.is_present() && !atlas.ok_at_least.is_present())
    ok.fail("gives no bound; give \"below\", \"at_least\" or both");
  atlas.otherwise =
      place.has("otherwise") ? chosen(place["otherwise"], {"inaccurate", "drifts"}) : "inaccurate";
  if (place.has("unstable_above")) atlas.unstable_above = Formula(place["unstable_above"]);
}

void read_run(const JsonPlace& place, FailureCase& atlas) {
  atlas.dt = formulas(place["dt"]);
  if (place.has("steps") == place.has("end"))
    place.fail("give either \"steps\" or \"end\", the time to reach [s]");
  if (place.has("steps")) atlas.steps = Formula(place["steps"]);
  if (place.has("end")) atlas.end = Formula(place["end"]);
  if (place.has("mode")) {
    place["mode"].require_keys({"omega", "rate"});
    atlas.omega = Formula(place["mode"]["omega"]);
    atlas.rate = Formula(place["mode"]["rate"]);
  }
  if (place.has("forced")) {
    if (!place["forced"].value().is_boolean()) place["forced"].fail("is not true or false");
    atlas.is_forced = place["forced"].value().get<bool>();
  }
  atlas.methods = chosen_list(place, "methods", method_names(), names_in(methods()));
  atlas.precisions = chosen_list(place, "precisions", precision_list(), {"f64"});
  atlas.rotations = chosen_list(place, "rotations", rotation_list(), {"quaternion"});
  if (place.has("model")) atlas.model = chosen(place["model"], model_names());
  if (place.has("variant")) atlas.variant = place["variant"].text();
  load_variant(atlas.variant); // reports errors early
}

FailureCase read_case(const JsonPlace& place, const std::string& path) {
  place.require_keys({"case",           "scene",  "set",     "dt",         "steps",     "end",
                      "mode",           "forced", "methods", "precisions", "rotations", "model",
                      "variant",        "metric", "value",   "reference",  "ok",        "otherwise",
                      "unstable_above", "expect"});
  FailureCase atlas;
  atlas.name = place["case"].text();
  atlas.scene = scene_beside(path, place["scene"].text());
  atlas.sets = combinations(place, "set");
  read_run(place, atlas);
  read_question(place, atlas);
  atlas.names_limit =
      std::regex_search(place.value().dump(), std::regex("[^A-Za-z0-9_]limit[^A-Za-z0-9_]"));
  if (place.has("reference")) atlas.reference = read_reference(place["reference"], path);
  for (const JsonPlace& item : place["expect"].items())
    atlas.expectations.push_back(read_expectation(item));
  // reports errors early
  for (const std::vector<Override>& set : atlas.sets) load_scene(atlas.scene, set);
  return atlas;
}

} // namespace

FailureStudy read_failures(const StudyFile& file) {
  const JsonPlace& chosen_scale = file.scale;
  chosen_scale.require_keys({"leave_out"});
  FailureStudy atlas{file.name, file.title, file.path, {}};
  std::set<std::string> names;
  for (const JsonPlace& item : file.root["failures"].items()) {
    atlas.cases.push_back(read_case(item, file.path));
    if (!names.insert(atlas.cases.back().name).second)
      item["case"].fail(fmt::format("a second case \"{}\"; names differ", atlas.cases.back().name));
  }
  if (chosen_scale.has("leave_out"))
    for (const JsonPlace& item : chosen_scale["leave_out"].items())
      if (std::erase_if(atlas.cases,
                        [&](const FailureCase& one) { return one.name == item.text(); }) == 0)
        item.fail(fmt::format("\"{}\" is not a case of the study", item.text()));
  return atlas;
}

} // namespace dss
