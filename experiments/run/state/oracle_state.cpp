#include "experiments/run/state/oracle_state.hpp"
#include "experiments/run/state/state_file.hpp"
#include "experiments/run/timed/breakdown.hpp"
#include "solver/error.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/spectrum.hpp"
#include "solver/reference/oracle.hpp"

#include <fmt/format.h>
#include <sstream>

namespace dss {
namespace {

constexpr const char* state_format = "dssbench-oracle-1";

/// In place of exponential methods the oracle takes short steps of another one.
struct ShortSteps {
  const Method& method;
  long of_step; ///< short steps
};

ShortSteps short_steps(const Problem& problem, const Method& method, double dt) {
  constexpr double phase = 0.2; // an undamped step of verner8 errs by some phase^9 / 9! = 1.4e-12
  if (!method.is_exponential) return {method, 1};
  return {*find_method("verner8"), 1 + long(spectrum_bound(problem).omega_max * dt / phase)};
}

} // namespace

OracleState compute_oracle_state(const Problem& problem, const Method& method, Rotation rotation,
                                 double dt, long steps, std::string key) {
  OracleState result{std::move(key), steps, initial_state(problem)};
  const ShortSteps by = short_steps(problem, method, dt);
  Oracle<long double> oracle(problem, by.method, dt / double(by.of_step), rotation);
  oracle.write(result.state);
  if (const auto breakdown = oracle.advance(steps * by.of_step))
    throw UnstableError(fmt::format("{}: by the oracle {}; take a smaller dt", problem.name,
                                    breakdown_text(breakdown->what, breakdown->step,
                                                   dt / double(by.of_step), breakdown->element)));
  oracle.read(result.state);
  return result;
}

std::vector<double> continue_by_oracle(const Problem& problem, const Method& method,
                                       Rotation rotation, double dt, long first_step, long steps,
                                       const std::vector<double>& state) {
  Oracle<long double> oracle(problem, method, dt, rotation);
  oracle.write(state);
  const std::size_t width = signal_count(problem);
  const std::vector<double> rows = signal_rows(problem, method, dt, first_step, steps);
  oracle.advance(steps, [&](long step, int stage) {
    return std::span<const double>(rows).subspan(std::size_t(step * method.stages + stage) * width,
                                                 width);
  });
  std::vector<double> result(state.size());
  oracle.read(result);
  return result;
}

void write_oracle_state(const std::string& path, const OracleState& state) {
  write_state_file(path, state_format, state.key,
                   fmt::format("{} {}", state.steps, state.state.size()), {&state.state, 1});
}

OracleState read_oracle_state(const std::string& path) {
  const std::string what = "is no oracle state; `dssbench experiment` makes them";
  StateFile file = read_state_file(path, state_format, what);
  OracleState result{std::move(file.key), 0, std::move(file.values)};
  std::size_t count = 0;
  if (!(std::istringstream(file.figures) >> result.steps >> count))
    throw InputError(fmt::format("{}: {}", path, what));
  if (result.state.size() != count) fail_cut_off(path);
  return result;
}

} // namespace dss
