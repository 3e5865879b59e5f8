#include "experiments/measure/study_file.hpp"
#include "experiments/run/plan/names.hpp"
#include "experiments/studies/failures/failure_case.hpp"
#include "solver/scene/method_name.hpp"
#include "solver/scene/scene.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <fmt/format.h>
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

/// Those of the atlas: exponential methods are of single runs.
std::vector<std::string> table_methods() {
  std::vector<std::string> names;
  for (const Method* method : all_methods()) names.emplace_back(method->name);
  return names;
}

std::string table_method_in(const Node& node) {
  std::string name = method_name_in(node);
  if (find_method(name)->is_exponential) node.fail("is of single runs; give another method");
  return name;
}

/// Reads a list of names; `otherwise` if the key is missing. "explicit" and "all" stand for groups
/// of methods.
std::vector<std::string> chosen_list(ObjectNode& object, const std::string& key,
                                     const std::vector<std::string>& known,
                                     std::vector<std::string> otherwise) {
  const auto node = object.find(key);
  if (!node) return otherwise;
  std::vector<std::string> list;
  for (const Node& item : node->list()) {
    if (key == "methods" && item.json() == "explicit")
      for (const std::string& name : names_in(methods())) list.push_back(name);
    else if (key == "methods" && item.json() == "all")
      list.insert(list.end(), known.begin(), known.end());
    else if (key == "methods")
      list.push_back(table_method_in(item));
    else
      list.push_back(item.known_name(key.substr(0, key.size() - 1).c_str(), known));
  }
  return list;
}

AtlasReference read_reference(const Node& node, const std::string& path) {
  ObjectNode object(node);
  AtlasReference reference;
  if (const auto converged = object.find("converged")) {
    reference.converged = converged->positive();
    if (const auto scene = object.find("scene"))
      reference.scene = scene_beside(path, scene->name());
    if (const auto base = object.find("base")) reference.base = std::size_t(base->whole(0));
    object.finish();
    return reference;
  }
  const std::string name =
      object.require("closed_form").known_name("closed form", names_in(closed_forms()));
  reference.form = &*std::ranges::find(closed_forms(), name, &ClosedForm::name);
  for (const char* argument : reference.form->arguments)
    reference.arguments.emplace(argument, Formula(object.require(argument)));
  object.finish();
  return reference;
}

Expectation read_expectation(const Node& node) {
  ObjectNode object(node);
  Expectation expected;
  expected.methods = chosen_list(object, "methods", table_methods(), {});
  expected.precisions = chosen_list(object, "precisions", names_of("PRECISION"), {});
  expected.rotations = chosen_list(object, "rotations", names_of("ROTATION"), {});
  expected.set = one_set(object, "set");
  expected.verdict = object.require("verdict").known_name(
      "verdict", {std::begin(atlas_verdicts), std::end(atlas_verdicts)});
  expected.why = object.require("why").name();
  expected.predicted = Formula(object, "predicted");
  if (expected.predicted.is_present() != object.has("within"))
    object.fail("\"predicted\" and \"within\" go together: a figure and the relative deviation "
                "that is allowed");
  if (expected.predicted.is_present()) {
    expected.within = object.require("within").positive();
    if (expected.verdict == "refused")
      object.require("predicted").fail("what is refused has no figure");
  }
  object.finish();
  return expected;
}

void read_value(const Node& node, FailureCase& atlas) {
  if (atlas.metric != "value") node.fail("belongs to the metric \"value\"");
  ObjectNode value(node);
  atlas.field = field_in(value.require("field"));
  atlas.element = Formula(value.require("element"));
  atlas.scale = Formula(value.require("scale"));
  value.finish();
}

void read_question(ObjectNode& object, FailureCase& atlas) {
  atlas.metric = object.require("metric").known_name("metric", atlas_metrics());
  if (atlas.metric == "value") object.must_have({"value"});
  if (const auto value = object.find("value")) read_value(*value, atlas);
  if (needs_reference(atlas.metric) != object.has("reference"))
    object.fail(fmt::format("the metric \"{}\" {} a \"reference\"", atlas.metric,
                            needs_reference(atlas.metric) ? "needs" : "does not take"));
  ObjectNode ok(object.require("ok"));
  atlas.ok_below = Formula(ok, "below");
  atlas.ok_at_least = Formula(ok, "at_least");
  ok.finish();
  if (!atlas.ok_below.is_present() && !atlas.ok_at_least.is_present())
    ok.fail("gives no bound; give \"below\", \"at_least\" or both");
  atlas.otherwise = "inaccurate";
  if (const auto otherwise = object.find("otherwise"))
    atlas.otherwise = otherwise->known_name("verdict", {"inaccurate", "drifts"});
  atlas.unstable_above = Formula(object, "unstable_above");
}

void read_run(ObjectNode& object, FailureCase& atlas) {
  atlas.dt = formulas(object.require("dt"));
  object.require_one({"steps", "end"});
  atlas.steps = Formula(object, "steps");
  atlas.end = Formula(object, "end");
  if (const auto node = object.find("mode")) {
    ObjectNode mode(*node);
    atlas.omega = Formula(mode.require("omega"));
    atlas.rate = Formula(mode.require("rate"));
    mode.finish();
  }
  atlas.is_forced = object.flag_or("forced", atlas.is_forced);
  atlas.methods = chosen_list(object, "methods", table_methods(), names_in(methods()));
  atlas.precisions = chosen_list(object, "precisions", names_of("PRECISION"), {"f64"});
  atlas.rotations = chosen_list(object, "rotations", names_of("ROTATION"), {"quaternion"});
  if (const auto model = object.find("model"))
    atlas.model = model->known_name("model", model_names());
  atlas.variant = object.name_or("variant", atlas.variant);
  load_variant(atlas.variant); // reports errors early
}

FailureCase read_case(const Node& node, const std::string& path) {
  ObjectNode object(node);
  FailureCase atlas;
  atlas.name = object.require("case").name();
  atlas.scene = scene_beside(path, object.require("scene").name());
  atlas.sets = combinations(object, "set");
  read_run(object, atlas);
  read_question(object, atlas);
  atlas.names_limit =
      std::regex_search(node.json().dump(), std::regex("[^A-Za-z0-9_]limit[^A-Za-z0-9_]"));
  if (const auto reference = object.find("reference"))
    atlas.reference = read_reference(*reference, path);
  for (const Node& item : object.require("expect").items(1))
    atlas.expectations.push_back(read_expectation(item));
  object.finish();
  // reports errors early
  for (const std::vector<Override>& set : atlas.sets) load_scene(atlas.scene, set);
  return atlas;
}

} // namespace

FailureStudy read_failures(const StudyFile& file) {
  FailureStudy atlas{file.name, file.title, file.path, {}};
  std::set<std::string> names;
  for (const Node& item : file.part("failures").items(1)) {
    atlas.cases.push_back(read_case(item, file.path));
    if (!names.insert(atlas.cases.back().name).second)
      item.fail(fmt::format("a second case \"{}\"; names differ", atlas.cases.back().name));
  }
  ObjectNode scale(file.scale);
  if (const auto left_out = scale.find("leave_out"))
    for (const Node& item : left_out->list())
      if (std::erase_if(atlas.cases,
                        [&](const FailureCase& one) { return one.name == item.name(); }) == 0)
        item.fail(fmt::format("\"{}\" is not a case of the study", item.name()));
  scale.finish();
  return atlas;
}

} // namespace dss
