#include "experiments/runner/precision/solution.hpp"
#include "experiments/runner/precision/accuracy.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/numerics/stability.hpp"
#include "solver/reference/oracle.hpp"

#include <algorithm>
#include <cstring>
#include <sstream>

namespace dss {
namespace {

constexpr const char* magic = "dssbench-solution-1";
constexpr double first_part_of_limit = 0.5; ///< the first step over the stability limit
constexpr double safety = 1.2;              ///< more steps than the order promises to need

/// The error of the second of two runs of which it has twice the steps.
double estimated_error(const Problem& problem, const Method& method, const std::vector<std::vector<double>>& coarse,
                       const std::vector<std::vector<double>>& fine) {
  return accuracy_of(problem, fine, coarse).max / (std::exp2(method.order) - 1);
}

/// By what to multiply steps so that an error falls below a tolerance, rounded up; 1 where it is.
long needed_factor(double error, double tolerance, int order) {
  return std::max(1L, long(std::ceil(safety * std::pow(error / tolerance, 1.0 / order))));
}

} // namespace

std::vector<std::vector<double>> oracle_states(const Problem& problem, const Method& method, const SavedTimes& times,
                                               long steps_between) {
  std::vector<double> state(problem.lattice.element_count * field_count);
  initial_state(problem, 0, problem.lattice.element_count, state.data());
  const double dt = times.interval() / double(steps_between);
  Oracle<long double> oracle(problem, method, dt);
  oracle.write(state);
  std::vector<std::vector<double>> states;
  for (long k = 0; k < times.count; ++k) {
    if (const auto breakdown = oracle.advance(steps_between))
      throw UnstableError(fmt::format("{}: the oracle ({}, dt = {:g} s) is not finite after t = {:g} s, element {}",
                                      problem.name, method.name, dt, double(k) * times.interval(), breakdown->element));
    oracle.read(state);
    states.push_back(state);
  }
  return states;
}

Solution find_solution(const Problem& problem, const Method& method, const SolutionRule& rule, const SavedTimes& times,
                       const std::function<void(const std::string&)>& note) {
  const StabilityLimit limit = stable_step(problem, method, problem.lattice.element_count <= sharp_stability_elements);
  const double most_between = rule.most_steps / double(times.count);
  long steps = times.steps_between(std::min(first_part_of_limit * limit.dt, times.interval()));
  Solution solution{"", times, 0, 0, {}};
  auto coarse = oracle_states(problem, method, times, steps);
  while (true) {
    steps *= 2;
    solution.states = oracle_states(problem, method, times, steps);
    solution.error = estimated_error(problem, method, coarse, solution.states);
    solution.dt = times.interval() / double(steps);
    if (note)
      note(fmt::format("solution of {}: {} steps of {:.3g} s, estimated error {:.1e}", problem.name,
                       steps * times.count, solution.dt, solution.error));
    // The pair that is expected to end it: its coarser run needs half the steps.
    const long factor = needed_factor(solution.error, rule.tolerance, method.order);
    if (solution.error <= rule.tolerance || double(steps) * 2 > most_between) return solution;
    const long next = std::min(steps * factor, long(most_between)) / 2;
    if (next > steps)
      coarse = oracle_states(problem, method, times, steps = next);
    else
      coarse = std::move(solution.states);
  }
}

void write_solution(const std::string& path, const Solution& solution) {
  AtomicFile file(path);
  const std::size_t width = solution.states.empty() ? 0 : solution.states.front().size();
  file.write(fmt::format("{}\n{}\n{:.17g} {} {:.17g} {:.17g} {}\n", magic, solution.key, solution.times.end,
                         solution.times.count, solution.error, solution.dt, width));
  for (const std::vector<double>& state : solution.states)
    file.write({reinterpret_cast<const char*>(state.data()), width * sizeof(double)});
  file.commit();
}

Solution read_solution(const std::string& path) {
  const std::string text = read_text(path);
  std::istringstream head(text);
  std::string first_line, numbers;
  Solution solution;
  std::size_t width = 0;
  std::getline(head, first_line);
  std::getline(head, solution.key);
  std::getline(head, numbers);
  std::istringstream values(numbers);
  values >> solution.times.end >> solution.times.count >> solution.error >> solution.dt >> width;
  if (first_line != magic || !values || !head || solution.times.count < 1 || !(solution.times.end > 0))
    throw InputError(
        fmt::format("{}: is no solution; `dssbench experiment` makes them for studies of precision", path));
  const std::size_t begin = first_line.size() + solution.key.size() + numbers.size() + 3;
  const auto count = std::size_t(solution.times.count);
  if ((text.size() - begin) / sizeof(double) / count != width || text.size() != begin + count * width * sizeof(double))
    throw InputError(fmt::format("{}: is cut off; delete it, and `dssbench experiment` makes it anew", path));
  solution.states.assign(count, std::vector<double>(width));
  for (std::size_t k = 0; k < count && width > 0; ++k)
    std::memcpy(solution.states[k].data(), text.data() + begin + k * width * sizeof(double), width * sizeof(double));
  return solution;
}

} // namespace dss
