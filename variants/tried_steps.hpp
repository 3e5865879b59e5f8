#pragma once
/// Steps of one length by a method with an error stage, as Executor::advance: for whoever measures how fast steps are.
#include "solver/numerics/signal_rows.hpp"
#include "variants/api.hpp"

#include <algorithm>
#include <cmath>

namespace dss {

/// First element whose state is not finite.
inline std::size_t first_non_finite(Executor& executor, std::size_t elements) {
  std::vector<double> state(elements * field_count);
  executor.read(0, state);
  const auto bad = std::find_if(state.begin(), state.end(), [](double value) { return !std::isfinite(value); });
  return std::size_t(bad - state.begin()) / field_count;
}

/// All steps are accepted, and all are done, since neighbours of a part wait for them. Of steps of a run, which end with the first failure,
/// the element is that of the last state.
inline Outcome advance_by_tries(Executor& executor, const Setup& setup, long steps, std::span<const double> signals) {
  const std::size_t width = std::size_t(setup.method.stages) * signal_count(setup.problem);
  Outcome outcome{true, steps, 0};
  for (long n = 0; n < steps; ++n) {
    const StepMaxima maxima = executor.try_step(setup.dt, signals.subspan(std::size_t(n) * width, width));
    executor.accept_step();
    if (maxima.is_finite || !outcome.is_finite) continue;
    outcome = {false, n, first_non_finite(executor, setup.problem.lattice.element_count)};
    if (setup.part == nullptr) break;
  }
  return outcome;
}

} // namespace dss
