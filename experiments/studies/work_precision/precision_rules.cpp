#include "experiments/studies/work_precision/precision_rules.hpp"

#include <algorithm>
#include <functional>

namespace dss {
namespace {

Contender read_contender(const JsonPlace& place) {
  place.require_keys({"integrator", "precision", "dt"});
  return {method_name_in(place["integrator"]), place["precision"].text(),
          place.has("dt") ? place["dt"].positive() : 0};
}

} // namespace

PrecisionRules read_precision_rules(const JsonPlace& place) {
  place.require_keys({"solution", "tolerances", "comparisons"});
  PrecisionRules rules;
  if (place.has("solution")) rules.solution = read_solution_rule(place["solution"]);
  for (const JsonPlace& item : place["tolerances"].items())
    rules.tolerances.push_back(item.positive());
  std::ranges::sort(rules.tolerances, std::greater<>());
  if (!place.has("comparisons")) return rules;
  for (const JsonPlace& item : place["comparisons"].items()) {
    item.require_keys({"scene", "space", "contender", "base"});
    rules.comparisons.push_back({item["scene"].text(), item["space"].text(),
                                 read_contender(item["contender"]), read_contender(item["base"])});
  }
  return rules;
}

} // namespace dss
