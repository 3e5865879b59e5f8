#pragma once
/// Saved times: equally spaced times at which a run is compared with its solution.
#include "solver/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {

/// The times end * k / count for k = 1 .. count; t = 0 is not among them.
struct SavedTimes {
  double end = 0; ///< [s]
  long count = 0;

  double interval() const { return end / double(count); }
  /// Steps from one saved time to the next, none longer than dt [s]. A number that exceeds a whole
  /// number only by rounding counts as whole. Returns 1 for dt = 0, the limit of a method without a
  /// stable step.
  long steps_between(double dt) const {
    constexpr double most = 1e15;
    return dt > 0 ? long(std::clamp(std::ceil(interval() / dt * (1 - 1e-9)), 1.0, most)) : 1;
  }
  /// The same for a step that must divide the interval. @throws InputError if it does not
  long whole_steps_between(double dt) const {
    const long steps = std::lround(interval() / dt);
    if (steps < 1 || std::abs(double(steps) * dt - interval()) > 1e-9 * interval())
      throw InputError(fmt::format(
          "dt = {:.6g} s does not divide the {:.6g} s between saved times; give {:.17g}", dt,
          interval(), interval() / double(steps_between(dt))));
    return steps;
  }
};

} // namespace dss
