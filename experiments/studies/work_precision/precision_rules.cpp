#include "experiments/studies/work_precision/precision_rules.hpp"
#include "experiments/run/plan/names.hpp"
#include "solver/scene/method_name.hpp"

#include <algorithm>
#include <functional>

namespace dss {
namespace {

Contender read_contender(const Node& node) {
  ObjectNode object(node);
  const Contender contender{
      method_name_in(object.require("integrator")),
      object.require("precision").known_name("precision", names_of("PRECISION")),
      object.positive_or("dt", 0)};
  object.finish();
  return contender;
}

CostComparison read_comparison(const Node& node) {
  ObjectNode object(node);
  const CostComparison comparison{object.require("scene").name(), object.require("space").name(),
                                  read_contender(object.require("contender")),
                                  read_contender(object.require("base"))};
  object.finish();
  return comparison;
}

} // namespace

PrecisionRules read_precision_rules(const Node& node) {
  ObjectNode object(node);
  PrecisionRules rules;
  rules.solution = read_solution_rule(object);
  rules.tolerances = object.require("tolerances").positives();
  std::ranges::sort(rules.tolerances, std::greater<>());
  if (const auto comparisons = object.find("comparisons"))
    for (const Node& item : comparisons->items(1))
      rules.comparisons.push_back(read_comparison(item));
  object.finish();
  return rules;
}

} // namespace dss
