#pragma once
/// Functions of time for loads and for the frame. The core evaluates them once, in double, so every
/// variant sees the same numbers.
#include <limits>
#include <string>
#include <vector>

namespace dss {

/// A function of time t [s]: `offset` plus the function of its kind.
struct Signal {
  enum class Kind { constant, ramp, harmonic, table, rate, spline };
  Kind kind = Kind::constant;
  double amplitude = 1; ///< constant: value; ramp: final value; harmonic: amplitude; table,
                        ///< spline: factor; rate: grows by so much a second
  double duration = 0;  ///< ramp: linear from 0 at t = 0 to `amplitude` at t = `duration` [s]
  /// harmonic: amplitude * sin(2 pi frequency t + phase) [Hz], [rad]
  double frequency = 0, phase = 0;
  /// table: times [s], linear between points, constant outside. spline: a natural cubic spline,
  /// with `bends`, the second derivatives at the points; linear outside
  std::vector<double> times, values, bends;
  double offset = 0; ///< added to every kind
  /// A series of a file has no value after this time [s], and this name.
  double last = std::numeric_limits<double>::infinity();
  std::string source;
  double operator()(double t) const;
};
inline Signal no_signal() {
  Signal signal;
  signal.amplitude = 0;
  return signal;
}

/// A signal and its derivatives by time.
struct SignalMotion {
  double value = 0, rate = 0, acceleration = 0;
};
/// Of a signal that moves a frame: constant, harmonic, rate or spline.
SignalMotion motion_of(const Signal& signal, double t);
/// Makes a table a spline through its points. With less than three points it is linear.
void make_spline(Signal& signal);

/// Times after 0 at which a signal, or a derivative of it, jumps [s].
std::vector<double> kinks(const Signal& signal);

/// True if the signal is 0 at every time.
bool is_zero_always(const Signal& signal);

} // namespace dss
