#include "experiments/run/plan/exponential.hpp"

#include "solver/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

std::string why_kinked(const Signal& signal, double dt, long steps) {
  constexpr double rounding = 1e-9, most_rounding = 0.01; // of a step
  for (const double kink : kinks(signal)) {
    const double at = kink / dt;
    if (!(at > 0 && at < double(steps))) continue;
    if (std::abs(at - std::round(at)) > std::min(rounding * std::max(1.0, at), most_rounding))
      return fmt::format("a signal has a kink at {} s, within a step; give --dt {}, or another "
                         "--integrator",
                         kink, kink / std::ceil(at));
  }
  return {};
}

/// The polynomial through five points of a twentieth of a period errs by some 1e-8.
std::string why_too_fast(const Signal& signal, double dt) {
  constexpr double part_of_period = 0.05;
  if (signal.kind != Signal::Kind::harmonic || signal.amplitude == 0 ||
      std::abs(signal.frequency) * dt <= part_of_period)
    return {};
  return fmt::format("a step is too long for a signal of {} Hz; give --dt {:.2g} or less",
                     signal.frequency, 0.95 * part_of_period / std::abs(signal.frequency));
}

} // namespace

const Method& require_stepwise(const Method& method) {
  if (!method.is_exponential) return method;
  throw InputError(fmt::format("--integrator {}: is of runs alone; give another one", method.name));
}

std::string why_not_polynomial(const Problem& problem, double dt, long steps) {
  std::string why;
  problem.each_signal([&](const Signal& signal) {
    if (why.empty()) why = why_kinked(signal, dt, steps);
    if (why.empty()) why = why_too_fast(signal, dt);
  });
  return why;
}

} // namespace dss
