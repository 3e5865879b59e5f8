#include "experiments/measure/study_file.hpp"
#include "experiments/measure/study_names.hpp"
#include "experiments/studies/continuum/continuum_study.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

void read_refinement(const Node& node, double most, ContinuumCheck& check) {
  ObjectNode object(node);
  check.refined = object.require("parameter").name();
  check.spacing = Formula(object.require("spacing"));
  const Node values = object.require("values");
  object.finish();
  double before = 0;
  for (const Node& item : values.list()) {
    const double value = item.positive();
    if (value <= before)
      item.fail(fmt::format("{:g} does not refine {:g}; values ascend", value, before));
    before = value;
    if (value <= most) check.values.push_back(value);
  }
  if (check.values.empty())
    values.fail(fmt::format("has none up to {:g}, the most of this scale", most));
}

void read_quantity(const Node& node, ContinuumCheck& check) {
  ObjectNode object(node);
  check.quantity = object.require_one({"deflection", "frequencies", "critical_load"});
  ObjectNode what(object.require(check.quantity));
  object.finish();
  if (check.quantity == "deflection") {
    check.field = field_in(what.require("field"));
    check.element = Formula(what.require("element"));
  } else if (check.quantity == "frequencies") {
    check.count = what.require("count").count(1);
  } else {
    check.load_parameter = what.require("parameter").name();
  }
  what.finish();
}

void read_theory(const Node& node, ContinuumCheck& check) {
  if (node.is_object()) {
    ObjectNode object(node);
    ObjectNode beam(object.require("timoshenko_cantilever"));
    object.finish();
    check.bending = Formula(beam.require("bending"));
    check.shear = Formula(beam.require("shear"));
    check.mass = Formula(beam.require("mass"));
    check.rotary = Formula(beam.require("rotary"));
    check.length = Formula(beam.require("length"));
    return beam.finish();
  }
  check.theory = formulas(node);
  if (int(check.theory.size()) != check.count)
    node.fail(fmt::format("has {} figures; the quantity has {}", check.theory.size(), check.count));
}

ContinuumCheck read_check(const Node& node, const std::string& path, double most) {
  ObjectNode object(node);
  ContinuumCheck check;
  check.name = object.require("check").name();
  check.scene = scene_beside(path, object.require("scene").name());
  check.source = object.require("source").name();
  check.set = one_set(object, "set");
  read_refinement(object.require("refine"), most, check);
  read_quantity(object.require("quantity"), check);
  check.scale = Formula(object, "scale");
  read_theory(object.require("theory"), check);
  check.bar = object.require("bar").positive();
  check.bar_at = object.require("bar_at").positive();
  if (const auto expected = object.find("order")) {
    ObjectNode order(*expected);
    check.order = order.require("declared").positive();
    check.order_within = order.require("within").positive();
    order.finish();
  }
  object.finish();
  return check;
}

} // namespace

ContinuumStudy read_continuum(const StudyFile& file) {
  ObjectNode scale(file.scale);
  const double most = scale.positive_or("up_to", 1e9);
  scale.finish();
  ContinuumStudy continuum{file.name, file.title, file.path, {}};
  for (const Node& item : file.part("continuum").items(1))
    continuum.checks.push_back(read_check(item, file.path, most));
  return continuum;
}

} // namespace dss
