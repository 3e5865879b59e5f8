#include "solver/model/signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dss {
namespace {

/// Linear between the points, constant before the first and after the last.
double interpolate(const std::vector<double>& times, const std::vector<double>& values, double t) {
  const auto after = std::upper_bound(times.begin(), times.end(), t);
  if (after == times.begin()) return values.front();
  if (after == times.end()) return values.back();
  const auto k = std::size_t(after - times.begin());
  const double part = (t - times[k - 1]) / (times[k] - times[k - 1]);
  return values[k - 1] + part * (values[k] - values[k - 1]);
}

/// Beyond its ends a natural spline goes on with their slopes.
SignalMotion on_spline(const Signal& signal, double t) {
  const std::vector<double>&times = signal.times, &y = signal.values, &m = signal.bends;
  if (times.size() == 1) return {y.front(), 0, 0};
  const double at = std::clamp(t, times.front(), times.back());
  const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, at);
  const auto k = std::size_t(after - times.begin()) - 1;
  const double h = times[k + 1] - times[k], s = at - times[k], slope = (y[k + 1] - y[k]) / h;
  const double bend = (m[k + 1] - m[k]) / h, first = slope - h * (2 * m[k] + m[k + 1]) / 6;
  const double rate = first + s * (m[k] + s * bend / 2);
  const double value = y[k] + s * (first + s * (m[k] / 2 + s * bend / 6));
  return {value + (t - at) * rate, rate, t == at ? m[k] + s * bend : 0};
}

} // namespace

double Signal::operator()(double t) const {
  switch (kind) {
  case Kind::constant:
    return offset + amplitude;
  case Kind::ramp:
    return offset + (t >= duration ? amplitude : t <= 0 ? 0 : amplitude * (t / duration));
  case Kind::harmonic:
    return offset + amplitude * std::sin(2 * std::numbers::pi * frequency * t + phase);
  case Kind::table:
    return offset + amplitude * interpolate(times, values, t);
  case Kind::rate:
  case Kind::spline:
    return motion_of(*this, t).value;
  }
  return offset;
}

SignalMotion motion_of(const Signal& signal, double t) {
  const double w = 2 * std::numbers::pi * signal.frequency, a = signal.amplitude;
  switch (signal.kind) {
  case Signal::Kind::harmonic:
    return {signal(t), a * w * std::cos(w * t + signal.phase),
            -a * w * w * std::sin(w * t + signal.phase)};
  case Signal::Kind::rate:
    return {signal.offset + a * t, a, 0};
  case Signal::Kind::spline: {
    SignalMotion m = on_spline(signal, t);
    return {signal.offset + a * m.value, a * m.rate, a * m.acceleration};
  }
  default:
    return {signal(t), 0, 0};
  }
}

/// Solves the tridiagonal equations of the second derivatives M with h_k = t_(k+1) - t_k:
///   h_(k-1) M_(k-1) + 2 (h_(k-1) + h_k) M_k + h_k M_(k+1) = 6 (slope_k - slope_(k-1))
void make_spline(Signal& signal) {
  const std::vector<double>&t = signal.times, &y = signal.values;
  const std::size_t n = t.size();
  signal.kind = Signal::Kind::spline;
  signal.bends.assign(n, 0);
  std::vector<double> upper(n, 0); // of the eliminated rows
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double before = t[k] - t[k - 1], after = t[k + 1] - t[k];
    const double change = (y[k + 1] - y[k]) / after - (y[k] - y[k - 1]) / before;
    const double pivot = 2 * (before + after) - before * upper[k - 1];
    upper[k] = after / pivot;
    signal.bends[k] = (6 * change - before * signal.bends[k - 1]) / pivot;
  }
  for (std::size_t k = n; k-- > 1;) signal.bends[k - 1] -= upper[k - 1] * signal.bends[k];
}

std::vector<double> kinks(const Signal& signal) {
  if (signal.kind == Signal::Kind::ramp) return {signal.duration};
  return signal.times; // of tables and splines
}

bool is_zero_always(const Signal& signal) {
  if (signal.kind == Signal::Kind::constant) return signal.amplitude + signal.offset == 0;
  const bool has_no_values =
      !signal.values.empty() && std::all_of(signal.values.begin(), signal.values.end(),
                                            [](double value) { return value == 0; });
  return signal.offset == 0 && (signal.amplitude == 0 || has_no_values);
}

} // namespace dss
