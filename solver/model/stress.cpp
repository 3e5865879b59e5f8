#include "solver/model/stress.hpp"

#include "kernels/physics.hpp"
#include "solver/model/energy.hpp"
#include "solver/model/link_constants.hpp"
#include "solver/model/rotation_vector.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace dss {
namespace {

using Spatial = Physics<Model::spatial, double>;

/// Element of the spatial model, or of the linear or small model if P has rotation vectors.
template <class P>
typename P::element element_at(std::span<const double> state, std::size_t e) {
  std::array<double, field_count> f;
  std::copy_n(&state[e * field_count], f.size(), f.begin());
  if constexpr (P::fields != Spatial::fields) to_rotation_vector(f);
  typename P::element element{
      {f[ux], f[uy], f[uz]}, {f[vx], f[vy], f[vz]}, {}, {f[wx], f[wy], f[wz]}};
  if constexpr (P::fields == Spatial::fields) element.q.s = f[qs];
  element.q.x = f[qx], element.q.y = f[qy], element.q.z = f[qz];
  return element;
}

/// Force of a link on element i [N]. The shared laws want a constant axis, hence the template.
template <class P, int axis>
Vec3 link_force(const typename P::element& i, const typename P::element& j, double edge_i,
                double edge_j, LinkLaw law, const AxisConstants& c) {
  typename P::vec force;
  if (law == LinkLaw::material) {
    typename P::material_law constants{};
    constants.edge_i = edge_i, constants.edge_j = edge_j;
    set_material_constants(constants, c, axis);
    force = P::material_link(i, j, axis, constants, P::no_pressure(), true, true, false).force;
  } else {
    typename P::paper_law at_i{}, at_j{};
    set_paper_constants(at_i, c), set_paper_constants(at_j, c);
    at_i.edge = edge_i, at_i.half_edge = edge_i / 2;
    at_j.edge = edge_j, at_j.half_edge = edge_j / 2;
    force = P::vec_scale(c.k_normal, P::paper_link(i, j, axis, at_i, at_j, false, true).force);
  }
  return {force.x, force.y, force.z};
}
template <class P>
Vec3 link_force(const typename P::element& i, const typename P::element& j, int axis, double edge_i,
                double edge_j, LinkLaw law, const AxisConstants& c) {
  if (axis == 0) return link_force<P, 0>(i, j, edge_i, edge_j, law, c);
  if (axis == 1) return link_force<P, 1>(i, j, edge_i, edge_j, law, c);
  return link_force<P, 2>(i, j, edge_i, edge_j, law, c);
}

/// Arm from the centre to the upper face [m]. In linear equations it is the arm at rest.
template <class P>
Spatial::vec arm_of(const typename P::element& e, int axis, double edge) {
  if constexpr (std::is_same_v<typename P::lever, double>) {
    return Spatial::vec_along({0, 0, 0}, axis, edge / 2);
  } else {
    const auto arm = P::face_arm(e.q, axis, edge, edge / 2);
    return {arm.x, arm.y, arm.z};
  }
}

ElementStress stress_of(const Spatial::stress_tensor& s, double volume) {
  return {s.xx / volume,
          s.yy / volume,
          s.zz / volume,
          s.yz / volume,
          s.xz / volume,
          s.xy / volume,
          std::sqrt(Spatial::von_mises_squared(s)) / volume};
}

/// Force of the elements' pressures over a link, on its lower element [N].
struct LinkTension {
  std::size_t i, j;
  int axis;
  Vec3 force;
};

/// The reference has the pressures of elements.
std::vector<LinkTension> link_tensions(const Problem& problem, std::span<const double> state,
                                       Rotation equations) {
  std::vector<LinkTension> tensions;
  if (!problem.has_pressure()) return tensions;
  reference::Dynamics<double> terms = energy_terms(problem, equations);
  const std::vector<double> fields = placed(terms, state);
  const auto strains = terms.strains(fields, {});
  const auto resistance = [&](std::size_t e) { return terms.resistance(e, strains[e]); };
  const auto motion = [&](std::size_t e) { return terms.placed(e, &fields[e * field_count]); };
  for (const auto& link : terms.links()) {
    if (!terms.has_pressure(link)) continue;
    const auto pressure = terms.pressure_on(link, resistance(link.i), resistance(link.j));
    const auto force =
        terms.pressure_reaction_of(motion(link.i), motion(link.j), link, pressure).force;
    tensions.push_back({link.i, link.j, terms.axis(link), {force[0], force[1], force[2]}});
  }
  return tensions;
}

template <class P>
std::vector<ElementStress> stress_by(const Problem& problem, std::span<const double> state,
                                     Rotation equations) {
  const Lattice& lattice = problem.lattice;
  std::vector<int> body_of(lattice.element_count);
  lattice.for_each_element([&](std::size_t e, const Row& row, int) { body_of[e] = row.body; });
  const auto body = [&](std::size_t e) -> const Body& {
    return problem.bodies[std::size_t(body_of[e])];
  };
  std::vector<std::array<Vec3, 3>> forces(lattice.element_count);
  const std::vector<LinkTension> tensions = link_tensions(problem, state, equations);
  for (const LinkTension& link : tensions)
    for (const std::size_t e : {link.i, link.j})
      for (std::size_t n = 0; n < 3; ++n) forces[e][std::size_t(link.axis)][n] += link.force[n];
  const auto add_link = [&](std::size_t i, std::size_t j, int axis, LinkLaw law,
                            const AxisConstants& c) {
    const std::size_t a = std::size_t(axis);
    const Vec3 force = link_force<P>(element_at<P>(state, i), element_at<P>(state, j), axis,
                                     body(i).edge[a], body(j).edge[a], law, c);
    for (const std::size_t e : {i, j})
      for (std::size_t n = 0; n < 3; ++n) forces[e][a][n] += force[n];
  };
  lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    add_link(i, j, axis, body(i).law, body(i).link(axis, problem.link_kind(i, axis)));
  });
  for (const ExtraLink& link : problem.extra_links)
    add_link(link.i, link.j, link.axis, link.law, link.constants);

  std::vector<ElementStress> stress(lattice.element_count);
  for (std::size_t e = 0; e < stress.size(); ++e) {
    const typename P::element element = element_at<P>(state, e);
    const Vec3& edge = body(e).edge;
    Spatial::stress_tensor s{};
    for (const int axis : {0, 1, 2}) {
      const Vec3& f = forces[e][std::size_t(axis)];
      s = Spatial::stress_add(s, arm_of<P>(element, axis, edge[std::size_t(axis)]),
                              {f[0], f[1], f[2]});
    }
    stress[e] = stress_of(s, edge[0] * edge[1] * edge[2]);
  }
  return stress;
}

} // namespace

std::vector<ElementStress> element_stress(const Problem& problem, std::span<const double> state,
                                          Rotation equations) {
  if (equations == Rotation::linearised)
    return stress_by<Physics<Model::linear, double>>(problem, state, equations);
  if (equations == Rotation::small)
    return stress_by<Physics<Model::small, double>>(problem, state, equations);
  return stress_by<Spatial>(problem, state, equations);
}

} // namespace dss
