#pragma once
/// What `dssbench advise` holds to a tolerance: a quantity at the saved times of a run, and how far one run's is from another's.
#include "experiments/runner/state_access.hpp"
#include "solver/model/model.hpp"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace dss {

/// displacement of every element, its von Mises stress, or the total energy of the bodies.
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
/// How the error is measured, in words.
constexpr std::string_view measure_of(Quantity quantity) {
  constexpr std::array<std::string_view, 3> measures{
      "largest difference of a displacement over elements, axes and saved times, over the largest displacement at any "
      "of them",
      "largest difference of von Mises stress over elements and saved times, over the largest stress at any of them",
      "largest difference of the total energy over the saved times, over the largest energy at any of them"};
  return measures[std::size_t(quantity)];
}

/// A quantity at all saved times of a run.
struct Observed {
  std::vector<std::vector<double>> values; ///< by saved time: u [m], von Mises [Pa] or energy [J]
  KindValues largest{};                    ///< of the states met
};

/// Adds what a state shows at the next saved time. Energy is that of the model's own equations, as `dssbench run` gives it.
void observe(const Problem& problem, Quantity quantity, Model model, std::span<const double> state, Observed& observed);

/// Error by measure_of: for displacements that of Accuracy::max (accuracy.hpp). Infinite where a number is not finite.
double observed_error(const Problem& problem, Quantity quantity, const Observed& expected, const Observed& actual);

/// Of whole states at the saved times, as solutions have them.
Observed observed_of(const Problem& problem, Quantity quantity, const std::vector<std::vector<double>>& states);

} // namespace dss
