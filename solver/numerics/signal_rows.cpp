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

/// Rows of the stages of a step whose signals are polynomials.
void append_weighted(const Problem& problem, const Method& method, double t, double dt,
                     std::vector<double>& rows) {
  std::vector<double> points;
  for (int p = 0; p < signal_points; ++p)
    append_row(problem, t + double(p) / signal_parts * dt, points);
  const std::size_t width = points.size() / signal_points;
  for (const auto& weights : method.signal_weights)
    for (std::size_t column = 0; column < width; ++column) {
      double sum = points[column]; // a constant signal stays what it is
      for (std::size_t p = 1; p < weights.size(); ++p)
        sum += weights[p] * (points[p * width + column] - points[column]);
      rows.push_back(sum);
    }
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
  for (long n = 0; n < steps; ++n) {
    const double step = double(first_step + n);
    if (!method.signal_weights.empty())
      append_weighted(problem, method, step * dt, dt, rows);
    else
      for (const double node : method.node) append_row(problem, (step + node) * dt, rows);
  }
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
