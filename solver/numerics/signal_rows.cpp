#include "solver/numerics/signal_rows.hpp"

#include "solver/model/frame.hpp"

namespace dss {

namespace {

void append_row(const Problem& problem, double t, std::vector<double>& rows) {
  const std::size_t first = rows.size();
  for (const Signal& signal : problem.frame_acceleration) rows.push_back(signal(t));
  for (const Load& load : problem.loads) rows.push_back(load.signal(t));
  if (!problem.has_rotating_frame()) return;
  const FrameTurn turn = turn_of_frame(problem, t);
  Eigen::Map<Eigen::Vector3d> acceleration(&rows[first]);
  acceleration = Eigen::Vector3d(turn.axes.transpose() * acceleration);
  rows.insert(rows.end(), turn.rate.begin(), turn.rate.end());
  rows.insert(rows.end(), turn.acceleration.begin(), turn.acceleration.end());
}

} // namespace

std::vector<double> signals_at(const Problem& problem, double t) {
  std::vector<double> row;
  append_row(problem, t, row);
  return row;
}

std::vector<double> signal_rows(const Problem& problem, const Method& method, double dt,
                                long first_step, long steps) {
  std::vector<double> rows;
  rows.reserve((std::size_t(steps) * std::size_t(method.stages) + 1) * signal_count(problem));
  for (long n = 0; n < steps; ++n)
    for (int s = 0; s < method.stages; ++s)
      append_row(problem, (double(first_step + n) + method.node[std::size_t(s)]) * dt, rows);
  append_row(problem, double(first_step + steps) * dt, rows);
  return rows;
}

std::vector<double> stage_signals(const Problem& problem, const Method& method, double t,
                                  double dt) {
  std::vector<double> rows;
  rows.reserve(std::size_t(method.stages) * signal_count(problem));
  for (const double node : method.node) append_row(problem, t + node * dt, rows);
  return rows;
}

} // namespace dss
