#pragma once
/// Functions of time for loads and for the frame. The core evaluates them once, in double, so every
/// variant sees the same numbers.
#include <limits>
#include <string>
#include <vector>

namespace dss {

/// A function of time t [s]: `offset` plus the function of its kind.
struct Signal {
  enum class Kind { constant, ramp, harmonic, table };
  Kind kind = Kind::constant;
  double amplitude = 1; ///< constant: value; ramp: final value; harmonic: amplitude; table: factor
  double duration = 0;  ///< ramp: linear from 0 at t = 0 to `amplitude` at t = `duration` [s]
  /// harmonic: amplitude * sin(2 pi frequency t + phase) [Hz], [rad]
  double frequency = 0, phase = 0;
  std::vector<double> times, values; ///< table: times [s], linear between points, constant outside
  double offset = 0;                 ///< added to every kind
  /// A series of a file has no value after this time [s], and this name.
  double last = std::numeric_limits<double>::infinity();
  std::string source;
  double operator()(double t) const;
};
/// True if the signal is 0 at every time.
bool is_zero_always(const Signal& signal);

} // namespace dss
