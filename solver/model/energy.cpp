#include "solver/model/energy.hpp"

#include "solver/error.hpp"
#include "solver/reference/dynamics.hpp"

#include <fmt/format.h>

namespace dss {

double total_energy(const Problem& problem, std::span<const double> state) {
  const std::size_t expected = problem.lattice.element_count * field_count;
  if (state.size() != expected)
    throw InputError(fmt::format("energy of {}: the state has {} numbers; {} elements need {}", problem.name,
                                 state.size(), problem.lattice.element_count, expected));
  return reference::Dynamics<double>(problem).energy(state);
}

} // namespace dss
