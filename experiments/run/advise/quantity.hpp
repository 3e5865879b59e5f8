#pragma once
/// The quantity that `dssbench advise` keeps within a tolerance: its values at the saved times of a
/// run, and the error of one run against another.
#include "experiments/run/state/saved_times.hpp"
#include "experiments/run/state/state_access.hpp"
#include "kernels/model.hpp"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace dss {

/// Displacement of every element, its von Mises stress, or the total energy of the bodies.
enum class Quantity { displacement, stress, energy };
inline constexpr std::array quantities{Quantity::displacement, Quantity::stress, Quantity::energy};

constexpr std::string_view name(Quantity quantity) {
  constexpr std::array<std::string_view, 3> names{"displacement", "stress", "energy"};
  return names[std::size_t(quantity)];
}
constexpr std::optional<Quantity> find_quantity(std::string_view text) {
  for (const Quantity quantity : quantities)
    if (name(quantity) == text) return quantity;
  return std::nullopt;
}
/// Definition of the error, as text.
constexpr std::string_view measure_of(Quantity quantity) {
  constexpr std::array<std::string_view, 3> measures{
      "largest difference of a displacement over elements, axes and saved times, over the largest "
      "displacement at any "
      "of them",
      "largest difference of von Mises stress over elements and saved times, over the largest "
      "stress at any of them",
      "largest difference of the total energy over the saved times, over the largest energy at any "
      "of them"};
  return measures[std::size_t(quantity)];
}

/// Values of a quantity at all saved times of a run.
struct Observed {
  /// by saved time: u [m], von Mises stress [Pa] or energy [J]
  std::vector<std::vector<double>> values;
  KindValues largest{}; ///< of all states
};

/// Adds the values of a state at the next saved time [s]. The energy is that of the model's own
/// equations, as in `dssbench run`.
void observe(const Problem& problem, Quantity quantity, Model model, std::span<const double> state,
             double time, Observed& observed);

/// Error as measure_of defines it; for displacements equal to Accuracy::max (accuracy.hpp).
/// Infinite if a number is not finite.
double observed_error(const Problem& problem, Quantity quantity, const Observed& expected,
                      const Observed& actual);

/// Values of whole states at the saved times, such as those of a solution.
Observed observed_of(const Problem& problem, Quantity quantity, const SavedTimes& times,
                     const std::vector<std::vector<double>>& states);

} // namespace dss
