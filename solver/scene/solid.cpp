#include "solver/scene/solid.hpp"

#include "solver/error.hpp"

#include <fmt/format.h>

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

/// What tells the elements of a body apart: 8 times the place of their material among those of the
/// body, plus ThinAxes.
using ElementKind = std::uint16_t;
/// Links of a body are alike if their elements are of the same kinds, in either order.
using LinkKind = std::pair<ElementKind, ElementKind>;
LinkKind kind_of(ElementKind i, ElementKind j) { return std::minmax({i, j}); }

/// The kinds of a body's links along one axis, numbered.
class KindNumbers {
public:
  static constexpr std::uint8_t none = 0xff;
  /// @param materials  of the body
  explicit KindNumbers(std::size_t materials)
      : kinds_of_elements_(8 * materials), numbers_(kinds_of_elements_ * kinds_of_elements_, none) {
  }
  /// @return false if there are too many
  bool add(const LinkKind& kind) {
    std::uint8_t& number = numbers_[place(kind)];
    if (number != none) return true;
    number = std::uint8_t(kinds_.size());
    kinds_.push_back(kind);
    return kinds_.size() <= none;
  }
  std::uint8_t of(const LinkKind& kind) const { return numbers_[place(kind)]; }
  const std::vector<LinkKind>& kinds() const { return kinds_; }

private:
  std::size_t place(const LinkKind& kind) const {
    return kinds_of_elements_ * kind.first + kind.second;
  }
  std::size_t kinds_of_elements_;
  std::vector<std::uint8_t> numbers_;
  std::vector<LinkKind> kinds_;
};

/// The materials of a body, and the masses of their elements over that of the body.
struct MaterialSide {
  const Material* material;
  double mass_ratio;
};
std::vector<MaterialSide> sides_of(const BodyMaterials& materials, const Body& body) {
  std::vector<MaterialSide> sides;
  for (const auto& [number, material] : materials.all())
    sides.push_back(
        {&material, body.mass_ratios.empty() ? 1 : body.mass_ratios[std::size_t(number)]});
  return sides;
}

/// Two halves of a link in series, each half of a link.
void join_halves(const AxisConstants& other, AxisConstants& link) {
  const auto join = [](double& k, double j) { k = k + j > 0 ? 2 * k * j / (k + j) : 0; };
  join(link.k_normal, other.k_normal);
  for (std::size_t a = 0; a < 3; ++a) {
    join(link.k_shear[a], other.k_shear[a]);
    join(link.k_rot[a], other.k_rot[a]);
  }
}

AxisConstants link_of(std::span<const MaterialSide> sides, const Body& body, int axis,
                      const LinkKind& kind) {
  const MaterialSide &i = sides[kind.first / 8U], &j = sides[kind.second / 8U];
  const auto thin = [](ElementKind element) { return ThinAxes(element % 8U); };
  const PairOfElements pair = pair_of_elements(body, body, axis, i.mass_ratio, j.mass_ratio);
  const auto link_in = [&](const Material& material) {
    return solid_link(material, axis, body.edge, thin(kind.first), thin(kind.second), pair.mass,
                      pair.inertia);
  };
  AxisConstants link = link_in(*i.material);
  if (i.material == j.material) return link;
  join_halves(link_in(*j.material), link);
  set_damping((i.material->damping_ratio + j.material->damping_ratio) / 2, pair.mass, pair.inertia,
              link);
  return link;
}

using BodyKinds = std::array<KindNumbers, 3>; // on each axis

void set_body_links(const BodyMaterials& materials, const BodyKinds& kinds, Body& body) {
  const std::vector<MaterialSide> sides = sides_of(materials, body);
  std::size_t count = 1;
  for (const KindNumbers& of_axis : kinds) count = std::max(count, of_axis.kinds().size());
  body.more_kinds.resize(count - 1);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    const std::vector<LinkKind>& of_axis = kinds[a].kinds();
    // No link has the constants of an axis without links, but analyses read them.
    body.axis[a] = link_of(sides, body, axis, of_axis.empty() ? LinkKind{} : of_axis.front());
    for (std::size_t n = 1; n < count; ++n)
      body.more_kinds[n - 1][a] =
          n < of_axis.size() ? link_of(sides, body, axis, of_axis[n]) : body.axis[a];
  }
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

void set_extra_link(const Material& material, ThinAxes thin_i, ThinAxes thin_j,
                    const PairOfElements& pair, ExtraLink& link) {
  link.constants =
      solid_link(material, link.axis, pair.edge, thin_i, thin_j, pair.mass, pair.inertia);
}

[[noreturn]] void refuse_kinds(const Body& body, const char* what) {
  throw InputError(fmt::format("body \"{}\": its materials make more than {} kinds of {}; give it "
                               "fewer materials",
                               body.name, KindNumbers::none, what));
}

void set_pressures(const Solids& solids, std::span<const ThinAxes> thin, Problem& problem) {
  const std::vector<FreeFaces> free = free_faces(problem.lattice);
  problem.pressure_kinds.resize(problem.lattice.element_count);
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
    const BodyMaterials& materials = solids.bodies[std::size_t(row.body)];
    if (!materials.is_contracting()) return;
    Body& body = problem.bodies[std::size_t(row.body)];
    const ElementPressure own =
        element_pressure(materials.of(problem.material(e)), body.edge, free[e], thin[e]);
    const auto alike = std::ranges::find(body.pressures, own);
    if (alike - body.pressures.begin() > KindNumbers::none) refuse_kinds(body, "pressures");
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

/// Of each element. @param body_of  of each element
std::vector<ElementKind> element_kinds(const Solids& solids, std::span<const ThinAxes> thin,
                                       std::span<const int> body_of, const Problem& problem) {
  std::vector<ElementKind> kinds(thin.begin(), thin.end());
  if (problem.materials.empty()) return kinds;
  std::vector<std::array<ElementKind, 256>> first(solids.bodies.size()); // by material
  for (std::size_t b = 0; b < first.size(); ++b)
    for (ElementKind place = 0; const auto& [number, material] : solids.bodies[b].all())
      first[b][std::size_t(number)] = ElementKind(8U * place++);
  for (std::size_t e = 0; e < kinds.size(); ++e)
    kinds[e] = ElementKind(kinds[e] + first[std::size_t(body_of[e])][problem.materials[e]]);
  return kinds;
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
  if (std::ranges::none_of(solids.bodies, &BodyMaterials::is_solid) && solids.extra_links.empty())
    return;
  std::vector<std::size_t> joints;
  for (const auto& [n, material] : solids.extra_links) joints.push_back(n);
  const std::vector<ThinAxes> thin = thin_axes(problem, joints);
  std::vector<int> body_of(thin.size());
  problem.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int) { body_of[e] = row.body; });
  const std::vector<ElementKind> elements = element_kinds(solids, thin, body_of, problem);
  std::vector<BodyKinds> kinds;
  for (const BodyMaterials& body : solids.bodies) {
    const KindNumbers none(std::max<std::size_t>(1, body.count()));
    kinds.push_back({none, none, none});
  }
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    const auto b = std::size_t(body_of[i]);
    if (!kinds[b][std::size_t(axis)].add(kind_of(elements[i], elements[j])))
      refuse_kinds(problem.bodies[b], "links");
  });
  for (std::size_t b = 0; b < problem.bodies.size(); ++b)
    if (solids.bodies[b].is_solid()) set_body_links(solids.bodies[b], kinds[b], problem.bodies[b]);
  for (const auto& [n, material] : solids.extra_links) {
    ExtraLink& link = problem.extra_links[n];
    const Body &from = problem.bodies[std::size_t(body_of[link.i])],
               &to = problem.bodies[std::size_t(body_of[link.j])];
    set_extra_link(material, thin[link.i], thin[link.j],
                   pair_of_elements(from, to, link.axis, problem.mass_ratio(link.i, from),
                                    problem.mass_ratio(link.j, to)),
                   link);
  }
  if (std::ranges::any_of(solids.bodies, &BodyMaterials::is_contracting))
    set_pressures(solids, thin, problem);
  if (std::ranges::all_of(problem.bodies, [](const Body& body) { return body.kinds() == 1; }))
    return;
  problem.link_kinds.resize(thin.size());
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    const auto a = std::size_t(axis), b = std::size_t(body_of[i]);
    if (solids.bodies[b].is_solid())
      problem.link_kinds[i][a] = kinds[b][a].of(kind_of(elements[i], elements[j]));
  });
}

} // namespace dss
