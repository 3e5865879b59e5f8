#include "experiments/measure/solution_rule.hpp"
#include "experiments/measure/study_names.hpp"
#include "solver/scene/method_name.hpp"

namespace dss {

SolutionRule read_solution_rule(ObjectNode& object) {
  SolutionRule rule;
  const auto node = object.find("solution");
  if (!node) return rule;
  ObjectNode solution(*node);
  if (const auto variant = solution.find("variant")) {
    rule.variant = variant->text();
    if (rule.variant != "auto") known_variant(rule.variant, *variant);
  }
  if (const auto model = solution.find("model")) {
    rule.model = model_in(*model);
    if (rule.variant.empty()) model->fail("only a variant has models; give \"variant\" too");
  }
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
