#include "experiments/run/timed/oracle_check.hpp"

#include "experiments/run/state/state_access.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {

bool OracleCheck::has_tail() const {
  return plan_.tail_steps > 0 && !plan_.adaptive && plan_.expected->steps < plan_.steps &&
         plan_.method->family == Method::Family::runge_kutta && !plan_.method->is_exponential;
}

long OracleCheck::tail_start() const {
  return std::max(plan_.expected->steps, plan_.steps - plan_.tail_steps);
}

std::vector<long> OracleCheck::stops() const {
  if (!plan_.expected) return {};
  std::vector<long> steps{plan_.expected->steps};
  if (has_tail()) steps.insert(steps.end(), {tail_start(), plan_.steps});
  return steps;
}

bool OracleCheck::is_wanted(long step) const { return std::ranges::count(stops(), step) > 0; }

void OracleCheck::look(long step, std::span<const double> state, Rotation equations,
                       CheckResult& check) {
  const Problem& problem = plan_.scene.problem;
  if (step == plan_.expected->steps) {
    check.is_done = true;
    check.how = plan_.adaptive ? fmt::format("oracle at t = {:g} s", double(step) * plan_.dt)
                               : fmt::format("oracle after {} steps", step);
    check.tolerance = plan_.tolerance().run;
    check.error = state_error(problem, plan_.expected->state, state);
  }
  if (!has_tail()) return;
  if (step == tail_start()) tail_state_.assign(state.begin(), state.end());
  if (step != plan_.steps) return;
  const long steps = plan_.steps - tail_start();
  const auto expected = continue_by_oracle(problem, *plan_.method, equations, plan_.dt,
                                           tail_start(), steps, tail_state_);
  check.tail_error = state_error(problem, expected, state);
  check.how += fmt::format(", and over the last {}", steps);
}

void judge_check(RunResult& result) {
  const CheckResult& check = result.check;
  if (!check.is_done || check.is_passed()) return;
  result.status = "wrong";
  result.reason = check.tail_error && !(*check.tail_error <= check.tolerance)
                      ? fmt::format("error {:.3g} over the last steps exceeds the tolerance {:.3g}",
                                    *check.tail_error, check.tolerance)
                      : fmt::format("error {:.3g} ({}) exceeds the tolerance {:.3g}", check.error,
                                    check.how, check.tolerance);
}

} // namespace dss
