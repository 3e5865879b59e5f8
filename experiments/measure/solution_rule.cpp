#include "experiments/measure/solution_rule.hpp"
#include "experiments/run/plan/run_plan.hpp"
#include "solver/error.hpp"

namespace dss {

std::string method_name_in(const Node& node) {
  try {
    return std::string(require_method(node.name()).name);
  } catch (const InputError& error) {
    node.fail(error.what());
  }
}

SolutionRule read_solution_rule(ObjectNode& object) {
  SolutionRule rule;
  const auto node = object.find("solution");
  if (!node) return rule;
  ObjectNode solution(*node);
  if (const auto integrator = solution.find("integrator"))
    rule.integrator = method_name_in(*integrator);
  rule.tolerance = solution.positive_or("tolerance", rule.tolerance);
  rule.most_steps = solution.positive_or("most_steps", rule.most_steps);
  solution.finish();
  return rule;
}

SavedTimes read_saved_times(ObjectNode& object, double shorten) {
  return {object.require("end_time").positive() * shorten, object.require("saved_times").whole(1)};
}

} // namespace dss
