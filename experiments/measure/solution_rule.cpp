#include "experiments/measure/solution_rule.hpp"
#include "experiments/run/plan/run_plan.hpp"

namespace dss {

std::string method_name_in(const JsonPlace& place) {
  try {
    return std::string(require_method(place.text()).name);
  } catch (const InputError& error) {
    place.fail(error.what());
  }
}

SolutionRule read_solution_rule(const JsonPlace& place) {
  place.require_keys({"integrator", "tolerance", "most_steps"});
  SolutionRule rule;
  if (place.has("integrator")) rule.integrator = method_name_in(place["integrator"]);
  if (place.has("tolerance")) rule.tolerance = place["tolerance"].positive();
  if (place.has("most_steps")) rule.most_steps = place["most_steps"].positive();
  return rule;
}

SavedTimes read_saved_times(const JsonPlace& place, double shorten) {
  return {place["end_time"].positive() * shorten, place["saved_times"].count(1)};
}

} // namespace dss
