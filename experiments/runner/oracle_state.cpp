#include "experiments/runner/oracle_state.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/oracle.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <sstream>

namespace dss {
namespace {

constexpr const char* magic = "dssbench-oracle-1";

} // namespace

OracleState compute_oracle_state(const Problem& problem, const Method& method, double dt, long steps, std::string key) {
  OracleState result{std::move(key), steps, std::vector<double>(problem.lattice.element_count * field_count)};
  initial_state(problem, 0, problem.lattice.element_count, result.state.data());
  Oracle<long double> oracle(problem, method, dt);
  oracle.write(result.state);
  if (const auto breakdown = oracle.advance(steps))
    throw UnstableError(
        fmt::format("{}: the oracle is not finite at step {} (t = {:g} s), element {}; take a smaller dt", problem.name,
                    breakdown->step, double(breakdown->step) * dt, breakdown->element));
  oracle.read(result.state);
  return result;
}

std::vector<double> continue_by_oracle(const Problem& problem, const Method& method, double dt, long first_step,
                                       long steps, const std::vector<double>& state) {
  Oracle<long double> oracle(problem, method, dt);
  oracle.write(state);
  const std::size_t width = signal_count(problem);
  const std::vector<double> rows = signal_rows(problem, method, dt, first_step, steps);
  oracle.advance(steps, [&](long step, int stage) {
    return std::span<const double>(rows).subspan(std::size_t(step * method.stages + stage) * width, width);
  });
  std::vector<double> result(state.size());
  oracle.read(result);
  return result;
}

void write_oracle_state(const std::string& path, const OracleState& state) {
  AtomicFile file(path);
  file.write(fmt::format("{}\n{}\n{} {}\n", magic, state.key, state.steps, state.state.size()));
  constexpr std::size_t piece = 8192;
  for (std::size_t first = 0; first < state.state.size(); first += piece) {
    const std::size_t count = std::min(piece, state.state.size() - first);
    file.write({reinterpret_cast<const char*>(&state.state[first]), count * sizeof(double)});
  }
  file.commit();
}

OracleState read_oracle_state(const std::string& path) {
  const std::string text = read_text(path);
  std::istringstream head(text);
  std::string first_line, sizes;
  OracleState result;
  std::size_t count = 0;
  std::getline(head, first_line);
  std::getline(head, result.key);
  std::getline(head, sizes);
  if (first_line != magic || !(std::istringstream(sizes) >> result.steps >> count) || !head)
    throw InputError(fmt::format("{}: is no oracle state; `dssbench experiment` makes them", path));
  const std::size_t begin = first_line.size() + result.key.size() + sizes.size() + 3;
  if (text.size() != begin + count * sizeof(double))
    throw InputError(fmt::format("{}: is cut off; delete it, and `dssbench experiment` makes it anew", path));
  result.state.resize(count);
  std::memcpy(result.state.data(), text.data() + begin, count * sizeof(double));
  return result;
}

} // namespace dss
