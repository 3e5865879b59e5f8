#include "solver/scene/solid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

namespace dss {
namespace {

/// Divisor of the shear stiffness that an element's half of a link has; 2.4 / 2 is the shear factor
/// 6 / 5 of a rectangle.
constexpr double thin_shear = 2.4;

double shear_divisor(ThinAxes thin, std::size_t axis) { return thin >> axis & 1 ? thin_shear : 1; }

/// Torsion constant [m^4] that an element's half of a link has, with the edges b and c across.
double twist_constant(double b, double c, bool is_thin_b, bool is_thin_c) {
  if (is_thin_b && is_thin_c) return torsion_constant(b, c);
  if (is_thin_b || (!is_thin_c && b < c)) return c * b * b * b / 6;
  return b * c * c * c / 6;
}

bool is_of_chain(ThinAxes thin) { return std::popcount(thin) >= 2; }

/// Modulus of an element's half of a link against stretching and bending.
double modulus(const Material& material, ThinAxes thin) {
  return material.nu == 0 || is_of_chain(thin) ? material.E[0] : 2 * material.G[0];
}

/// Links of a body are alike if their elements are thin along the same axes, in either order.
using LinkKind = std::pair<ThinAxes, ThinAxes>;
LinkKind kind_of(ThinAxes i, ThinAxes j) { return std::minmax({i, j}); }

/// The kinds of a body's links along one axis, numbered.
class KindNumbers {
public:
  static constexpr std::uint8_t none = 0xff;
  KindNumbers() { numbers_.fill(none); }
  void add(const LinkKind& kind) {
    std::uint8_t& number = numbers_[place(kind)];
    if (number != none) return;
    number = std::uint8_t(kinds_.size());
    kinds_.push_back(kind);
  }
  std::uint8_t of(const LinkKind& kind) const { return numbers_[place(kind)]; }
  const std::vector<LinkKind>& kinds() const { return kinds_; }

private:
  static std::size_t place(const LinkKind& kind) { return 8U * kind.first + kind.second; }
  std::array<std::uint8_t, 64> numbers_;
  std::vector<LinkKind> kinds_;
};

AxisConstants link_of(const Material& material, const Body& body, int axis, const LinkKind& kind) {
  const Vec3 reduced = {body.inertia[0] / 2, body.inertia[1] / 2, body.inertia[2] / 2};
  return solid_link(material, axis, body.edge, kind.first, kind.second, body.mass / 2, reduced);
}

using BodyKinds = std::array<KindNumbers, 3>; // on each axis

void set_body_links(const Material& material, const BodyKinds& kinds, Body& body) {
  std::size_t count = 1;
  for (const KindNumbers& of_axis : kinds) count = std::max(count, of_axis.kinds().size());
  body.more_kinds.resize(count - 1);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    const std::vector<LinkKind>& of_axis = kinds[a].kinds();
    // No link has the constants of an axis without links, but analyses read them.
    body.axis[a] = link_of(material, body, axis, of_axis.empty() ? LinkKind{} : of_axis.front());
    for (std::size_t n = 1; n < count; ++n)
      body.more_kinds[n - 1][a] =
          n < of_axis.size() ? link_of(material, body, axis, of_axis[n]) : body.axis[a];
  }
}

void set_extra_link(const Material& material, ThinAxes thin_i, ThinAxes thin_j, const Body& from,
                    const Body& to, ExtraLink& link) {
  const PairOfElements pair = pair_of_elements(from, to, link.axis);
  link.constants =
      solid_link(material, link.axis, pair.edge, thin_i, thin_j, pair.mass, pair.inertia);
}

using FreeFaces = std::array<int, 3>; // across x, y, z

std::vector<FreeFaces> free_faces(const Lattice& lattice) {
  std::vector<FreeFaces> free(lattice.element_count, FreeFaces{2, 2, 2});
  lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    --free[i][std::size_t(axis)];
    --free[j][std::size_t(axis)];
  });
  return free;
}

void set_pressures(const Solids& solids, std::span<const ThinAxes> thin, Problem& problem) {
  const std::vector<FreeFaces> free = free_faces(problem.lattice);
  problem.pressure_kinds.resize(problem.lattice.element_count);
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
    const std::optional<Material>& material = solids.bodies[std::size_t(row.body)];
    if (!material || material->nu == 0) return;
    Body& body = problem.bodies[std::size_t(row.body)];
    const ElementPressure own = element_pressure(*material, body.edge, free[e], thin[e]);
    const auto alike = std::ranges::find(body.pressures, own);
    problem.pressure_kinds[e] = std::uint8_t(alike - body.pressures.begin());
    if (alike == body.pressures.end()) body.pressures.push_back(own);
  });
  // Chains have none.
  const auto is_nothing = [](const Body& body) {
    return std::ranges::all_of(body.pressures, [](const ElementPressure& pressure) {
      return pressure == ElementPressure{};
    });
  };
  for (Body& body : problem.bodies)
    if (is_nothing(body)) body.pressures.clear();
  if (std::ranges::all_of(problem.bodies, is_nothing)) problem.pressure_kinds.clear();
}

} // namespace

void set_face_strain(const Material& material, const Vec3& edge, Load& load) {
  const std::size_t axis = std::size_t(load.face) / 2;
  const double area = edge[(axis + 1) % 3] * edge[(axis + 2) % 3];
  load.face_strain = (load.face % 2 == 1 ? 1 : -1) * load.force[axis] / area / (4 * material.G[0]);
}

ElementPressure element_pressure(const Material& material, const Vec3& edge, const FreeFaces& free,
                                 ThinAxes thin) {
  ElementPressure pressure;
  if (is_of_chain(thin)) return pressure;
  const double G = material.G[0], lambda = 2 * G * material.nu / (1 - 2 * material.nu);
  const auto with_free = [&](int faces) { return lambda / (1 + faces * lambda / (4 * G)); };
  const int all = free[0] + free[1] + free[2];
  pressure.volume = with_free(all);
  for (std::size_t o = 0; o < 3; ++o)
    if (thin == 1U << o)
      pressure.bending[o] = edge[o] * edge[o] / 12 * with_free(2 + all - free[o]);
  return pressure;
}

AxisConstants solid_link(const Material& material, int axis, const Vec3& edge, ThinAxes i,
                         ThinAxes j, double mass, const Vec3& inertia) {
  const auto a = std::size_t(axis);
  const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
  const double G_over_L = material.G[a] / edge[a], area = edge[b] * edge[c];
  AxisConstants link = material_link(material, axis, edge, mass, inertia);
  const double share = (modulus(material, i) + modulus(material, j)) / (2 * material.E[a]);
  for (double* const k : {&link.k_normal, &link.k_rot[b], &link.k_rot[c]}) *k *= share;
  for (const std::size_t d : {b, c})
    link.k_shear[d] = 4 * G_over_L * area / (shear_divisor(i, d) + shear_divisor(j, d));
  const auto twist = [&](ThinAxes thin) {
    return twist_constant(edge[b], edge[c], (thin >> b & 1) != 0, (thin >> c & 1) != 0);
  };
  link.k_rot[a] = G_over_L * (twist(i) + twist(j)) / 2;
  set_damping(material.damping_ratio, mass, inertia, link);
  return link;
}

void set_solid_links(const Solids& solids, Problem& problem) {
  const auto is_solid = [&](int body) { return solids.bodies[std::size_t(body)].has_value(); };
  if (std::ranges::none_of(solids.bodies, [](const auto& solid) { return solid.has_value(); }) &&
      solids.extra_links.empty())
    return;
  std::vector<std::size_t> joints;
  for (const auto& [n, material] : solids.extra_links) joints.push_back(n);
  const std::vector<ThinAxes> thin = thin_axes(problem, joints);
  std::vector<int> body_of(thin.size());
  problem.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int) { body_of[e] = row.body; });
  std::vector<BodyKinds> kinds(problem.bodies.size());
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    kinds[std::size_t(body_of[i])][std::size_t(axis)].add(kind_of(thin[i], thin[j]));
  });
  for (std::size_t b = 0; b < problem.bodies.size(); ++b)
    if (is_solid(int(b))) set_body_links(*solids.bodies[b], kinds[b], problem.bodies[b]);
  for (const auto& [n, material] : solids.extra_links) {
    ExtraLink& link = problem.extra_links[n];
    const auto body = [&](std::size_t e) -> const Body& {
      return problem.bodies[std::size_t(body_of[e])];
    };
    set_extra_link(material, thin[link.i], thin[link.j], body(link.i), body(link.j), link);
  }
  const auto is_contracting = [](const std::optional<Material>& m) { return m && m->nu > 0; };
  if (std::ranges::any_of(solids.bodies, is_contracting)) set_pressures(solids, thin, problem);
  if (std::ranges::all_of(problem.bodies, [](const Body& body) { return body.kinds() == 1; }))
    return;
  problem.link_kinds.resize(thin.size());
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    const auto a = std::size_t(axis);
    if (is_solid(body_of[i]))
      problem.link_kinds[i][a] = kinds[std::size_t(body_of[i])][a].of(kind_of(thin[i], thin[j]));
  });
}

} // namespace dss
