#include "solver/scene/solid.hpp"

#include <algorithm>
#include <array>
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

} // namespace

AxisConstants solid_link(const Material& material, int axis, const Vec3& edge, ThinAxes i,
                         ThinAxes j, double mass, const Vec3& inertia) {
  const auto a = std::size_t(axis);
  const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
  const double G_over_L = material.G[a] / edge[a], area = edge[b] * edge[c];
  AxisConstants link = material_link(material, axis, edge, mass, inertia);
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
