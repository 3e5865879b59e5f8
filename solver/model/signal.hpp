#pragma once
/// Functions of time of loads and of the frame. Evaluated once, by the core, in double: every variant sees the same
/// numbers.
#include <vector>

namespace dss {

struct Signal {
  enum class Kind { constant, ramp, harmonic, table };
  Kind kind = Kind::constant;
  double amplitude = 1;              ///< value, final value, amplitude, or scale of the table
  double duration = 0;               ///< ramp: linear from 0 at t = 0 to amplitude at t = duration [s]
  double frequency = 0, phase = 0;   ///< harmonic: amplitude * sin(2 pi frequency t + phase) [Hz], [rad]
  std::vector<double> times, values; ///< table: linear between points, constant outside [s]
  double offset = 0;                 ///< added to every kind
  double operator()(double t) const;
};
bool is_zero_always(const Signal& signal);

} // namespace dss
