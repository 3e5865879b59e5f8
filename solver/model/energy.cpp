#include "solver/model/energy.hpp"

#include "solver/error.hpp"

#include <algorithm>
#include <fmt/format.h>

#include <vector>

namespace dss {

reference::Dynamics<double> energy_terms(const Problem& problem, Rotation rotation) {
  return reference::Dynamics<double>(problem,
                                     has_vectors(rotation) ? rotation : Rotation::quaternion);
}

std::vector<double> placed(reference::Dynamics<double>& terms, std::span<const double> state) {
  std::vector<double> fields(state.begin(), state.end());
  for (std::size_t e = 0; e < terms.element_count(); ++e) {
    double* of_element = &fields[e * field_count];
    const auto q = reference::of_unit_length(reference::orientation_fields(of_element));
    reference::set_orientation_fields(of_element, terms.coordinates().write(e, q));
  }
  return fields;
}

double total_energy(const Problem& problem, std::span<const double> state, Rotation rotation) {
  const std::size_t expected = problem.lattice.element_count * field_count;
  if (state.size() != expected)
    throw InputError(fmt::format("energy of {}: the state has {} numbers; {} elements need {}",
                                 problem.name, state.size(), problem.lattice.element_count,
                                 expected));
  reference::Dynamics<double> terms = energy_terms(problem, rotation);
  return terms.energy(placed(terms, state));
}

bool has_dampers(const Problem& problem) {
  const auto is_body_damped = [](const Body& body) {
    bool is_damped = false;
    body.each_kind([&](const AxisConstants& a, int) { is_damped |= a.is_damped(); });
    return is_damped;
  };
  const auto is_link_damped = [](const ExtraLink& link) { return link.constants.is_damped(); };
  const Stabilization& ties = problem.stabilization;
  return ties.d != 0 || ties.d_rot != 0 || std::ranges::any_of(problem.bodies, is_body_damped) ||
         std::ranges::any_of(problem.extra_links, is_link_damped);
}

bool conserves_energy(const Problem& problem) {
  return !has_dampers(problem) && problem.loads.empty() && !problem.has_rotating_frame() &&
         std::ranges::all_of(problem.frame_acceleration, is_zero_always);
}

} // namespace dss
