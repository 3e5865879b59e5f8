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
  }
  return offset;
}

bool is_zero_always(const Signal& signal) {
  if (signal.kind == Signal::Kind::constant) return signal.amplitude + signal.offset == 0;
  const bool has_no_values =
      signal.kind == Signal::Kind::table && std::all_of(signal.values.begin(), signal.values.end(),
                                                        [](double value) { return value == 0; });
  return signal.offset == 0 && (signal.amplitude == 0 || has_no_values);
}

} // namespace dss
