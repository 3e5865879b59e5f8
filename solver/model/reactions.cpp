#include "solver/model/reactions.hpp"

#include "solver/model/energy.hpp"

#include <Eigen/Geometry>

#include <vector>

namespace dss {
namespace {

/// @param fields  the state as `placed` gives it
Reactions clamp_reactions(const Problem& problem, reference::Dynamics<double>& terms,
                          std::span<const double> fields, std::span<const double> signals) {
  const std::size_t count = problem.lattice.element_count;
  std::vector<std::uint8_t> clamped(count); // an element may have several clamps
  for (const Clamp& clamp : problem.clamps) clamped[clamp.element] |= clamp.dofs;
  std::vector<double> wrenches(6 * count);
  terms.wrenches(fields, signals, wrenches);
  // Linear equations balance moments about the places at rest.
  const bool is_moved = terms.coordinates().rotation() != Rotation::linearised;
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    if (clamped[e] == 0) return;
    Eigen::Vector3d of_force = Eigen::Vector3d::Zero(), of_moment = of_force;
    for (int a = 0; a < 3; ++a) {
      const double* const wrench = &wrenches[6 * e + std::size_t(a)];
      if ((clamped[e] & (dof_ux << a)) != 0) of_force[a] = -wrench[0];
      if ((clamped[e] & (dof_rx << a)) != 0) of_moment[a] = -wrench[3];
    }
    const Vec3 rest = rest_position(problem, row, x);
    Eigen::Vector3d place(rest[0], rest[1], rest[2]);
    if (is_moved) place += Eigen::Map<const Eigen::Vector3d>(&fields[e * field_count + ux]);
    force += of_force;
    moment += place.cross(of_force) + of_moment;
  });
  return {{force[0], force[1], force[2]}, {moment[0], moment[1], moment[2]}};
}

} // namespace

EnergyAndReactions energy_and_reactions(const Problem& problem, std::span<const double> state,
                                        Rotation equations, std::span<const double> signals) {
  reference::Dynamics<double> terms = energy_terms(problem, equations);
  return energy_and_reactions(problem, terms, placed(terms, state), signals);
}

EnergyAndReactions energy_and_reactions(const Problem& problem, reference::Dynamics<double>& terms,
                                        std::span<const double> fields,
                                        std::span<const double> signals) {
  EnergyAndReactions found{terms.energy(fields), {}};
  if (!problem.clamps.empty()) found.reactions = clamp_reactions(problem, terms, fields, signals);
  return found;
}

} // namespace dss
