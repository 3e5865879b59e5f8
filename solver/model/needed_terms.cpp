#include "solver/model/needed_terms.hpp"

#include "kernels/stage_row/element_pressure.hpp"
#include "solver/model/link_constants.hpp"

#include <algorithm>

namespace dss {

/// Whether pressures of a body's elements have moments. Then links have two shears too, unless
/// their constants happen to be equal.
static bool bends(const Body& body) {
  return std::ranges::any_of(
      body.pressures, [](const ElementPressure& pressure) { return pressure.bending != Vec3{}; });
}

std::vector<Terms> needed_terms(const Problem& problem, Model model) {
  const int axes = descriptor(model).axes;
  Terms common;
  // Full rows alone have the code of a frame that rotates, and of elements that differ in mass.
  const bool is_full = problem.has_rotating_frame() || problem.has_mass_ratios();
  common.is_tied = problem.stabilization.is_present() || is_full;
  common.is_gyroscopic = is_full;
  for (const Body& body : problem.bodies) {
    body.each_kind([&](const AxisConstants& a, int) {
      common.is_damped |= a.is_damped();
      common.is_bending |= body.law == LinkLaw::paper && a.k_rot != Vec3{};
    });
    common.is_gyroscopic |=
        body.has_tensor_inertia() && !is_of_plane(model) && model != Model::axial;
  }
  // Rows do not compute extra links. Still, leapfrog must carry predicted velocities for damped
  // ones, and in all parts alike.
  common.is_damped |= problem.has_damped_links_elsewhere;
  for (const ExtraLink& link : problem.extra_links) common.is_damped |= link.constants.is_damped();
  std::vector<Terms> needs(problem.bodies.size(), common);
  for (std::size_t b = 0; b < needs.size(); ++b) {
    const Body& body = problem.bodies[b];
    needs[b].is_material = body.law == LinkLaw::material;
    needs[b].has_two_shears = needs[b].is_material && axes > 1 &&
                              (degrees_of(model) & dof_uz) != 0 &&
                              (has_two_shears(body) || bends(body));
    Terms with_pressure = needs[b];
    with_pressure.has_pressure = true;
    needs[b].has_pressure =
        !body.pressures.empty() && pressure_parts(model, with_pressure).count() > 0;
    needs[b].is_oblong =
        (axes > 1 && body.edge[1] != body.edge[0]) || (axes > 2 && body.edge[2] != body.edge[0]);
  }
  return needs;
}

} // namespace dss
