#pragma once
/// Equally spaced times at which a run and the solution that it is measured against are compared.
#include "solver/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {

/// Times end * k / count, k = 1 .. count; t = 0 is none of them.
struct SavedTimes {
  double end = 0; ///< [s]
  long count = 0;

  double interval() const { return end / double(count); }
  /// Steps from one saved time to the next, none longer than dt [s]. What exceeds a whole number by rounding alone counts as whole.
  /// One for dt = 0, the limit of a method of which no step is stable.
  long steps_between(double dt) const {
    constexpr double most = 1e15;
    return dt > 0 ? long(std::clamp(std::ceil(interval() / dt * (1 - 1e-9)), 1.0, most)) : 1;
  }
  /// The same for a step that must fit. @throws InputError if it does not divide the interval
  long whole_steps_between(double dt) const {
    const long steps = std::lround(interval() / dt);
    if (steps < 1 || std::abs(double(steps) * dt - interval()) > 1e-9 * interval())
      throw InputError(fmt::format("dt = {:.6g} s does not divide the {:.6g} s between saved times; give {:.17g}", dt,
                                   interval(), interval() / double(steps_between(dt))));
    return steps;
  }
};

} // namespace dss
