#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/studies/continuum/continuum_study.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>

namespace dss {
namespace {

void read_refinement(const JsonPlace& place, double most, ContinuumCheck& check) {
  place.require_keys({"parameter", "values", "spacing"});
  check.refined = place["parameter"].text();
  check.spacing = Formula(place["spacing"]);
  double before = 0;
  for (const JsonPlace& item : place["values"].items()) {
    const double value = item.positive();
    if (value <= before)
      item.fail(fmt::format("{:g} does not refine {:g}; values ascend", value, before));
    before = value;
    if (value <= most) check.values.push_back(value);
  }
  if (check.values.empty())
    place["values"].fail(fmt::format("has none up to {:g}, the most of this scale", most));
}

void read_quantity(const JsonPlace& place, ContinuumCheck& check) {
  const std::vector<std::string> known = {"deflection", "frequencies", "critical_load"};
  if (!place.value().is_object() || place.value().size() != 1)
    place.fail("is not an object of one key");
  check.quantity = place.value().begin().key();
  if (std::ranges::find(known, check.quantity) == known.end())
    place.fail(fmt::format("unknown quantity \"{}\"; {}", check.quantity,
                           nearest_name(check.quantity, known)));
  const JsonPlace what = place[check.quantity];
  if (check.quantity == "deflection") {
    what.require_keys({"field", "element"});
    check.field = what["field"].text();
    if (std::ranges::find(field_names(), check.field) == field_names().end())
      what["field"].fail(
          fmt::format("unknown field; {}", nearest_name(check.field, field_names())));
    check.element = Formula(what["element"]);
  } else if (check.quantity == "frequencies") {
    what.require_keys({"count"});
    check.count = int(what["count"].count(1));
  } else {
    what.require_keys({"parameter"});
    check.load_parameter = what["parameter"].text();
  }
}

void read_theory(const JsonPlace& place, ContinuumCheck& check) {
  if (place.value().is_object()) {
    place.require_keys({"timoshenko_cantilever"});
    const JsonPlace beam = place["timoshenko_cantilever"];
    beam.require_keys({"bending", "shear", "mass", "rotary", "length"});
    check.bending = Formula(beam["bending"]);
    check.shear = Formula(beam["shear"]);
    check.mass = Formula(beam["mass"]);
    check.rotary = Formula(beam["rotary"]);
    check.length = Formula(beam["length"]);
    return;
  }
  check.theory = formulas(place);
  if (int(check.theory.size()) != check.count)
    place.fail(
        fmt::format("has {} figures; the quantity has {}", check.theory.size(), check.count));
}

ContinuumCheck read_check(const JsonPlace& place, const std::string& path, double most) {
  place.require_keys({"check", "scene", "set", "refine", "quantity", "scale", "theory", "source",
                      "bar", "bar_at", "order"});
  ContinuumCheck check;
  check.name = place["check"].text();
  check.scene = scene_beside(path, place["scene"].text());
  check.source = place["source"].text();
  if (place.has("set")) check.set = one_set(place["set"]);
  read_refinement(place["refine"], most, check);
  read_quantity(place["quantity"], check);
  if (place.has("scale")) check.scale = Formula(place["scale"]);
  read_theory(place["theory"], check);
  check.bar = place["bar"].positive();
  check.bar_at = place["bar_at"].positive();
  if (place.has("order")) {
    const JsonPlace order = place["order"];
    order.require_keys({"declared", "within"});
    check.order = order["declared"].positive();
    check.order_within = order["within"].positive();
  }
  return check;
}

} // namespace

ContinuumStudy read_continuum(const StudyFile& file) {
  file.scale.require_keys({"up_to"});
  const double most = file.scale.has("up_to") ? file.scale["up_to"].positive() : 1e9;
  ContinuumStudy continuum{file.name, file.title, file.path, {}};
  for (const JsonPlace& item : file.root["continuum"].items())
    continuum.checks.push_back(read_check(item, file.path, most));
  return continuum;
}

} // namespace dss
