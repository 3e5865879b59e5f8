#include "experiments/run/verify/expected_runs.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/verify/verified_methods.hpp"
#include "solver/reference/oracle.hpp"

#include <cmath>

namespace dss {

template <class T>
std::vector<double> ExpectedRuns::computed(const Method& method, Rotation equations, double dt,
                                           long steps) const {
  std::vector<double> state = initial_state(problem_);
  Oracle<T> oracle(problem_, method, dt, equations);
  oracle.write(state);
  oracle.advance(steps);
  oracle.read(state);
  return state;
}

const ExpectedRun& ExpectedRuns::run(const Method& method, Rotation equations, int halvings) {
  const auto [place, is_new] = runs_.try_emplace({&method, equations, halvings});
  ExpectedRun& expected = place->second;
  if (is_new) {
    // The step of the run that is not halved is kept: to find it takes long in large scenes.
    expected.dt = halvings == 0 ? verified_step(problem_, method)
                                : std::ldexp(run(method, equations).dt, -halvings);
    expected.state = computed<long double>(method, equations, expected.dt, steps_ << halvings);
  }
  return expected;
}

double ExpectedRuns::rounding_error(const Method& method, Rotation equations, Precision precision) {
  const ExpectedRun& expected = run(method, equations);
  return state_error(problem_, expected.state,
                     precision == Precision::f64
                         ? computed<double>(method, equations, expected.dt, steps_)
                         : computed<float>(method, equations, expected.dt, steps_));
}

} // namespace dss
