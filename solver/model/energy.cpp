#include "solver/model/energy.hpp"

#include "solver/error.hpp"
#include "solver/reference/dynamics.hpp"

#include <fmt/format.h>

#include <vector>

namespace dss {

double total_energy(const Problem& problem, std::span<const double> state, Rotation rotation) {
  const std::size_t expected = problem.lattice.element_count * field_count;
  if (state.size() != expected)
    throw InputError(fmt::format("energy of {}: the state has {} numbers; {} elements need {}", problem.name,
                                 state.size(), problem.lattice.element_count, expected));
  reference::Dynamics<double> dynamics(problem, rotation);
  if (rotation == Rotation::quaternion) return dynamics.energy(state);
  std::vector<double> fields(state.begin(), state.end());
  for (std::size_t e = 0; e < dynamics.element_count(); ++e) {
    double* of_element = &fields[e * field_count];
    reference::set_orientation_fields(of_element,
                                      dynamics.coordinates().write(e, reference::orientation_fields(of_element)));
  }
  return dynamics.energy(fields);
}

} // namespace dss
