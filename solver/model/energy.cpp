#include "solver/model/energy.hpp"

#include "solver/error.hpp"
#include "solver/reference/dynamics.hpp"

#include <algorithm>
#include <fmt/format.h>

#include <vector>

namespace dss {
namespace {

bool is_damped(const AxisConstants& link) {
  return link.d_normal != 0 || link.d_shear != 0 || link.d_rot != Vec3{};
}

} // namespace

double total_energy(const Problem& problem, std::span<const double> state, Rotation rotation) {
  const std::size_t expected = problem.lattice.element_count * field_count;
  if (state.size() != expected)
    throw InputError(fmt::format("energy of {}: the state has {} numbers; {} elements need {}",
                                 problem.name, state.size(), problem.lattice.element_count,
                                 expected));
  reference::Dynamics<double> dynamics(problem, rotation);
  if (rotation == Rotation::quaternion) return dynamics.energy(state);
  std::vector<double> fields(state.begin(), state.end());
  for (std::size_t e = 0; e < dynamics.element_count(); ++e) {
    double* of_element = &fields[e * field_count];
    reference::set_orientation_fields(
        of_element, dynamics.coordinates().write(e, reference::orientation_fields(of_element)));
  }
  return dynamics.energy(fields);
}

bool conserves_energy(const Problem& problem) {
  const auto is_body_damped = [](const Body& body) {
    return std::ranges::any_of(body.axis, is_damped);
  };
  const auto is_link_damped = [](const ExtraLink& link) { return is_damped(link.constants); };
  const Stabilization& ties = problem.stabilization;
  return ties.d == 0 && ties.d_rot == 0 && problem.loads.empty() &&
         std::ranges::all_of(problem.frame_acceleration, is_zero_always) &&
         std::ranges::none_of(problem.bodies, is_body_damped) &&
         std::ranges::none_of(problem.extra_links, is_link_damped);
}

} // namespace dss
