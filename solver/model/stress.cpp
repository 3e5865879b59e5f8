#include "solver/model/stress.hpp"

#include "kernels/physics.hpp"
#include "solver/model/link_constants.hpp"

#include <cmath>

namespace dss {
namespace {

using P = SpatialPhysics<double>;

P::element element_at(std::span<const double> state, std::size_t e) {
  const double* f = &state[e * field_count];
  return {{f[ux], f[uy], f[uz]}, {f[vx], f[vy], f[vz]}, {f[qs], f[qx], f[qy], f[qz]}, {f[wx], f[wy], f[wz]}};
}

/// Force of a link on element i [N]. The axis is a constant in each case, as the shared laws want it.
template <int axis>
P::vec link_force(const P::element& i, const P::element& j, double edge_i, double edge_j, LinkLaw law,
                  const AxisConstants& c) {
  if (law == LinkLaw::material) {
    P::material_law constants{};
    constants.edge_i = edge_i, constants.edge_j = edge_j;
    set_material_constants(constants, c);
    return P::material_link(i, j, axis, constants, true).force;
  }
  P::paper_law at_i{}, at_j{};
  set_paper_constants(at_i, c), set_paper_constants(at_j, c);
  at_i.edge = edge_i, at_i.half_edge = edge_i / 2;
  at_j.edge = edge_j, at_j.half_edge = edge_j / 2;
  return P::vec_scale(c.k_normal, P::paper_link(i, j, axis, at_i, at_j, false, true).force);
}
P::vec link_force(const P::element& i, const P::element& j, int axis, double edge_i, double edge_j, LinkLaw law,
                  const AxisConstants& c) {
  if (axis == 0) return link_force<0>(i, j, edge_i, edge_j, law, c);
  if (axis == 1) return link_force<1>(i, j, edge_i, edge_j, law, c);
  return link_force<2>(i, j, edge_i, edge_j, law, c);
}

} // namespace

std::vector<ElementStress> element_stress(const Problem& problem, std::span<const double> state) {
  const Lattice& lattice = problem.lattice;
  std::vector<int> body_of(lattice.element_count);
  lattice.for_each_element([&](std::size_t e, const Row& row, int) { body_of[e] = row.body; });
  const auto body = [&](std::size_t e) -> const Body& { return problem.bodies[std::size_t(body_of[e])]; };
  std::vector<std::array<P::vec, 3>> forces(lattice.element_count, {P::vec{0, 0, 0}, P::vec{0, 0, 0}, P::vec{0, 0, 0}});
  const auto add_link = [&](std::size_t i, std::size_t j, int axis, LinkLaw law, const AxisConstants& c) {
    const std::size_t a = std::size_t(axis);
    const P::vec f =
        link_force(element_at(state, i), element_at(state, j), axis, body(i).edge[a], body(j).edge[a], law, c);
    for (const std::size_t e : {i, j}) forces[e][a] = P::vec_add(forces[e][a], f);
  };
  lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    add_link(i, j, axis, body(i).law, body(i).axis[std::size_t(axis)]);
  });
  for (const ExtraLink& link : problem.extra_links) add_link(link.i, link.j, link.axis, link.law, link.constants);

  std::vector<ElementStress> stress(lattice.element_count);
  for (std::size_t e = 0; e < stress.size(); ++e) {
    const P::rotor q = element_at(state, e).q;
    const Vec3& edge = body(e).edge;
    P::stress_tensor s{};
    s = P::stress_add(s, P::face_arm(q, 0, edge[0], edge[0] / 2), forces[e][0]);
    s = P::stress_add(s, P::face_arm(q, 1, edge[1], edge[1] / 2), forces[e][1]);
    s = P::stress_add(s, P::face_arm(q, 2, edge[2], edge[2] / 2), forces[e][2]);
    const double volume = edge[0] * edge[1] * edge[2];
    stress[e] = {s.xx / volume,
                 s.yy / volume,
                 s.zz / volume,
                 s.yz / volume,
                 s.xz / volume,
                 s.xy / volume,
                 std::sqrt(P::von_mises_squared(s)) / volume};
  }
  return stress;
}

} // namespace dss
