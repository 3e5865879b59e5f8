#include "experiments/run/advise/quantity.hpp"
#include "solver/model/energy.hpp"
#include "solver/model/stress/stress_field.hpp"

#include "solver/numerics/signal_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dss {

void observe(const Problem& problem, Quantity quantity, Model model, std::span<const double> state,
             double time, Observed& observed) {
  const KindValues largest = largest_of_kinds(state);
  for (std::size_t kind = 0; kind < largest.size(); ++kind)
    observed.largest[kind] = std::max(observed.largest[kind], largest[kind]);
  std::vector<double>& values = observed.values.emplace_back();
  switch (quantity) {
  case Quantity::displacement:
    values.reserve(3 * state.size() / field_count);
    for (std::size_t at = 0; at < state.size(); at += field_count)
      values.insert(values.end(), {state[at + ux], state[at + uy], state[at + uz]});
    break;
  case Quantity::stress: {
    const StressField field(problem, state, rotation_of(model), signals_at(problem, time));
    for (const ElementStress& element : field.elements())
      values.push_back(von_mises(element.stress));
    break;
  }
  case Quantity::energy:
    values.push_back(total_energy(problem, state, rotation_of(model)));
    break;
  }
}

double observed_error(const Problem& problem, Quantity quantity, const Observed& expected,
                      const Observed& actual) {
  double difference = 0, scale = 0;
  for (std::size_t k = 0; k < expected.values.size(); ++k)
    for (std::size_t n = 0; n < expected.values[k].size(); ++n) {
      const double distance = std::abs(expected.values[k][n] - actual.values[k][n]);
      if (!std::isfinite(distance)) return std::numeric_limits<double>::infinity();
      difference = std::max(difference, distance);
      scale = std::max(scale, std::abs(expected.values[k][n]));
    }
  if (quantity == Quantity::displacement) scale = error_scales(problem, expected.largest)[0];
  return relative(difference, scale);
}

Observed observed_of(const Problem& problem, Quantity quantity, const SavedTimes& times,
                     const std::vector<std::vector<double>>& states) {
  Observed observed;
  for (std::size_t k = 0; k < states.size(); ++k)
    observe(problem, quantity, Model::spatial, states[k], double(k + 1) * times.interval(),
            observed);
  return observed;
}

} // namespace dss
