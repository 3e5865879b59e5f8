#include "experiments/runner/precision/precision_rules.hpp"
#include "experiments/runner/run_plan.hpp"

#include <algorithm>
#include <functional>

namespace dss {
namespace {

std::string known_method(const JsonPlace& place) {
  try {
    return std::string(require_method(place.text()).name);
  } catch (const InputError& error) {
    place.fail(error.what());
  }
}

Contender read_contender(const JsonPlace& place) {
  place.require_keys({"integrator", "precision", "dt"});
  return {known_method(place["integrator"]), place["precision"].text(), place.has("dt") ? place["dt"].positive() : 0};
}

} // namespace

SolutionRule read_solution_rule(const JsonPlace& place) {
  place.require_keys({"integrator", "tolerance", "most_steps"});
  SolutionRule rule;
  if (place.has("integrator")) rule.integrator = known_method(place["integrator"]);
  if (place.has("tolerance")) rule.tolerance = place["tolerance"].positive();
  if (place.has("most_steps")) rule.most_steps = place["most_steps"].positive();
  return rule;
}

PrecisionRules read_precision_rules(const JsonPlace& place) {
  place.require_keys({"solution", "tolerances", "comparisons"});
  PrecisionRules rules;
  if (place.has("solution")) rules.solution = read_solution_rule(place["solution"]);
  for (const JsonPlace& item : place["tolerances"].items()) rules.tolerances.push_back(item.positive());
  std::ranges::sort(rules.tolerances, std::greater<>());
  if (!place.has("comparisons")) return rules;
  for (const JsonPlace& item : place["comparisons"].items()) {
    item.require_keys({"scene", "space", "contender", "base"});
    rules.comparisons.push_back(
        {item["scene"].text(), item["space"].text(), read_contender(item["contender"]), read_contender(item["base"])});
  }
  return rules;
}

} // namespace dss
