#include "experiments/run/state/solution.hpp"
#include "experiments/run/plan/lack.hpp"
#include "experiments/run/state/accuracy.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/state/state_file.hpp"
#include "solver/cores.hpp"
#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/reference/oracle.hpp"
#include "variants/leaps/leap_executor.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <array>
#include <sstream>

namespace dss {
namespace {

constexpr const char* file_format = "dssbench-solution-1";
constexpr double first_part_of_limit = 0.9; ///< first step, relative to the stability limit
constexpr double safety = 1.2;              ///< safety factor on the predicted number of steps

using States = std::vector<std::vector<double>>;

/// Extrapolates two runs, of which the second has twice the steps: removes the leading error of
/// order p.
States extrapolated(const States& coarse, const States& fine, int order) {
  const double weight = 1 / (std::exp2(order) - 1);
  States limit = fine;
  for (std::size_t k = 0; k < fine.size(); ++k)
    for (std::size_t n = 0; n < fine[k].size(); ++n)
      limit[k][n] += weight * (fine[k][n] - coarse[k][n]);
  return limit;
}

/// Makes three runs, each with twice the steps of the one before, and extrapolates them.
Solution solution_of_three(const Problem& problem, const Method& method, const SolutionRule& rule,
                           const SavedTimes& times, long steps_between) {
  std::array<States, 3> runs;
  for (std::size_t r = 0; r < runs.size(); ++r)
    runs[r] = rule.variant.empty()
                  ? oracle_states(problem, method, times, steps_between << r)
                  : variant_states(problem, method, rule, times, steps_between << r);
  Solution solution{"", times, 0, times.interval() / double(steps_between << 2), {}};
  solution.states = extrapolated(runs[1], runs[2], method.order);
  const States coarser = extrapolated(runs[0], runs[1], method.order);
  solution.error =
      accuracy_of(problem, solution.states, coarser).max / (std::exp2(method.order + 1) - 1);
  return solution;
}

[[noreturn]] void fail_not_finite(const Problem& problem, const Method& method,
                                  std::string_view who, double dt, double t, std::size_t element) {
  throw UnstableError(
      fmt::format("{}: {} ({}, dt = {:g} s) is not finite after t = {:g} s, element {}",
                  problem.name, who, method.name, dt, t, element));
}

} // namespace

std::vector<std::vector<double>> oracle_states(const Problem& problem, const Method& method,
                                               const SavedTimes& times, long steps_between) {
  const double dt = times.interval() / double(steps_between);
  Oracle<long double> oracle(problem, method, dt);
  std::vector<double> state = initial_state(problem);
  oracle.write(state);
  std::vector<std::vector<double>> states;
  for (long k = 0; k < times.count; ++k) {
    if (const auto breakdown = oracle.advance(steps_between))
      fail_not_finite(problem, method, "the oracle", dt, double(k) * times.interval(),
                      breakdown->element);
    oracle.read(state);
    states.push_back(state);
  }
  return states;
}

std::string SolutionRule::key() const {
  return fmt::format("{} to {:g}{}", integrator, tolerance,
                     variant.empty() ? "" : fmt::format(" by {} {}", variant, name(model)));
}

/// @throws InputError if the variant, or the model, does not suffice
static const Plugin& sufficient_variant(const Problem& problem, const Method& method,
                                        const SolutionRule& rule) {
  const Plugin& plugin = load_variant(rule.variant);
  if (const auto lack = what_lacks(plugin, problem, Precision::f64, method, plugin.rotation))
    throw InputError(fmt::format("solution: {}: variant {} {}; give another one", lack->asked_by,
                                 plugin.name, lack->what));
  if (const std::string why = why_not(rule.model, problem); !why.empty())
    throw InputError(
        fmt::format("solution: model {}: {}: {}", name(rule.model), problem.name, why));
  return plugin;
}

std::vector<std::vector<double>> variant_states(const Problem& problem, const Method& method,
                                                const SolutionRule& rule, const SavedTimes& times,
                                                long steps_between) {
  constexpr long most_rows = 256; // of signals at once
  const double dt = times.interval() / double(steps_between);
  const Plugin& plugin = sufficient_variant(problem, method, rule);
  const auto executor = make_executor(plugin, {problem, method, rule.model, Precision::f64, dt,
                                               plugin.is_threaded ? usable_cores() : 1});
  write_initial_state(*executor, problem);
  std::vector<std::vector<double>> states;
  for (long k = 0, step = 0; k < times.count; ++k) {
    while (step < (k + 1) * steps_between) {
      const long steps = std::min(most_rows, (k + 1) * steps_between - step);
      const Outcome outcome =
          executor->advance(steps, signal_rows(problem, method, dt, step, steps));
      if (!outcome.is_finite)
        fail_not_finite(problem, method, plugin.name, dt, double(step) * dt, outcome.element);
      step += steps;
    }
    states.push_back(whole_state(*executor, problem.lattice.element_count));
  }
  return states;
}

Solution find_solution(const Problem& problem, const Method& method, const SolutionRule& rule,
                       const SavedTimes& times,
                       const std::function<void(const std::string&)>& note) {
  // a lower bound is enough to start with
  const StabilityLimit limit = stable_step(problem, method);
  const auto steps_of_finest = [&](long steps) { return 4 * steps * times.count; };
  long steps = times.steps_between(std::min(first_part_of_limit * limit.dt, times.interval()));
  while (true) {
    const Solution solution = solution_of_three(problem, method, rule, times, steps);
    if (note)
      note(fmt::format("solution of {}: {} steps of {:.3g} s, estimated error {:.1e}", problem.name,
                       steps_of_finest(steps), solution.dt, solution.error));
    if (solution.error <= rule.tolerance || double(steps_of_finest(2 * steps)) > rule.most_steps)
      return solution;
    const double factor =
        safety * std::pow(solution.error / rule.tolerance, 1.0 / (method.order + 1));
    const double most = rule.most_steps / double(steps_of_finest(steps));
    steps = long(std::ceil(double(steps) * std::clamp(factor, 1.2, most)));
  }
}

void write_solution(const std::string& path, const Solution& solution) {
  const std::size_t width = solution.states.empty() ? 0 : solution.states.front().size();
  write_state_file(path, file_format, solution.key,
                   fmt::format("{:.17g} {} {:.17g} {:.17g} {}", solution.times.end,
                               solution.times.count, solution.error, solution.dt, width),
                   solution.states);
}

Solution read_solution(const std::string& path) {
  const std::string what =
      "is no solution; `dssbench experiment` makes them for studies of precision";
  const StateFile file = read_state_file(path, file_format, what);
  Solution solution;
  solution.key = file.key;
  std::istringstream figures(file.figures);
  std::size_t width = 0;
  figures >> solution.times.end >> solution.times.count >> solution.error >> solution.dt >> width;
  if (!figures || solution.times.count < 1 || !(solution.times.end > 0))
    throw InputError(fmt::format("{}: {}", path, what));
  const auto count = std::size_t(solution.times.count);
  if (file.values.size() / count != width || file.values.size() % count != 0) fail_cut_off(path);
  for (auto state = file.values.begin(); state != file.values.end() && width > 0;
       state += std::ptrdiff_t(width))
    solution.states.emplace_back(state, state + std::ptrdiff_t(width));
  solution.states.resize(count);
  return solution;
}

} // namespace dss
