#pragma once
/// Executor::advance for a method with an error stage, by tried steps of one fixed length. Used to
/// measure the speed of such steps.
#include "solver/numerics/signal_rows.hpp"
#include "variants/api/api.hpp"

#include <algorithm>
#include <cmath>

namespace dss {

/// @param elements  number of elements of the scene
/// @return the first element whose state is not finite
inline std::size_t first_non_finite(Executor& executor, std::size_t elements) {
  std::vector<double> state(elements * field_count);
  executor.read(0, state);
  const auto bad =
      std::find_if(state.begin(), state.end(), [](double value) { return !std::isfinite(value); });
  return std::size_t(bad - state.begin()) / field_count;
}

/// Tries and accepts `steps` steps of setup.dt each. A whole problem stops at the first step that
/// fails. A part does all steps, because its neighbours wait for them. The element of the outcome
/// is the first non-finite one in the state after the failing step.
/// @param signals  method.stages rows for each step, see signal_rows.hpp
inline Outcome advance_by_tries(Executor& executor, const Setup& setup, long steps,
                                std::span<const double> signals) {
  const std::size_t width = std::size_t(setup.method.stages) * signal_count(setup.problem);
  Outcome outcome{true, steps, 0};
  for (long n = 0; n < steps; ++n) {
    const StepMaxima maxima =
        adaptive(executor).try_step(setup.dt, signals.subspan(std::size_t(n) * width, width));
    adaptive(executor).accept_step();
    if (maxima.is_finite || !outcome.is_finite) continue;
    outcome = {false, n, first_non_finite(executor, setup.problem.lattice.element_count)};
    if (setup.part == nullptr) break;
  }
  return outcome;
}

} // namespace dss
