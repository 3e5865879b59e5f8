#include "solver/numerics/signal_rows.hpp"

namespace dss {

std::vector<double> signal_rows(const Problem& problem, const Method& method, double dt, long first_step, long steps) {
  std::vector<double> rows;
  rows.reserve((std::size_t(steps) * std::size_t(method.stages) + 1) * signal_count(problem));
  const auto append_row = [&](double t) {
    for (const Signal& signal : problem.frame_acceleration) rows.push_back(signal(t));
    for (const Load& load : problem.loads) rows.push_back(load.signal(t));
  };
  for (long n = 0; n < steps; ++n)
    for (int s = 0; s < method.stages; ++s) append_row((double(first_step + n) + method.node[std::size_t(s)]) * dt);
  append_row(double(first_step + steps) * dt);
  return rows;
}

} // namespace dss
