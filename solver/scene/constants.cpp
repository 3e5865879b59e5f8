#include "solver/scene/constants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dss {
namespace {

const std::vector<std::string> law_names = {"paper", "material", "solid"};
enum Law { paper, material, solid }; // in the order of law_names

/// Reads a number for all axes, or [x, y, z].
Vec3 read_per_axis(const Node& node) {
  if (node.is_array()) return node.positive_vector();
  const double value = node.positive();
  return {value, value, value};
}

Vec3 read_non_negative_vector(const Node& node) {
  const Vec3 v = node.vector();
  if (std::min({v[0], v[1], v[2]}) < 0)
    node.fail(fmt::format("[{}, {}, {}] has a negative part", v[0], v[1], v[2]));
  return v;
}

/// The defaults are the published constants.
AxisConstants read_paper_link(ObjectNode& constants, int axis) {
  AxisConstants link;
  link.k_normal = constants.positive_or("k", 1e11);
  link.d_normal = constants.non_negative_or("d", 1e5);
  link.k_shear = across(axis, link.k_normal), link.d_shear = across(axis, link.d_normal);
  link.k_rot.fill(constants.non_negative_or("kt", 0));
  link.d_rot.fill(constants.non_negative_or("dt", 1e2));
  return link;
}

AxisConstants read_explicit_link(ObjectNode& constants, int axis) {
  AxisConstants link;
  link.k_normal = constants.require("k_normal").non_negative();
  link.k_shear = across(axis, constants.require("k_shear").non_negative());
  link.d_normal = constants.non_negative_or("d_normal", 0);
  link.d_shear = across(axis, constants.non_negative_or("d_shear", 0));
  if (const auto k_rot = constants.find("k_rot")) link.k_rot = read_non_negative_vector(*k_rot);
  if (const auto d_rot = constants.find("d_rot")) link.d_rot = read_non_negative_vector(*d_rot);
  return link;
}

/// @param contracts  bodies of the law contract across a pull if nu is not 0
Material read_material(ObjectNode& constants, bool contracts) {
  Material material;
  material.E = read_per_axis(constants.require("E"));
  const auto shear = constants.find("G"), poisson = constants.find("nu");
  if (shear && poisson) constants.fail("G and nu exclude each other; give one of them");
  const double nu = poisson ? poisson->number() : 0;
  constexpr double most = 0.49; // beyond it the pressure oscillates at coarse curved surfaces
  if (nu != 0 && !contracts)
    poisson->fail("this law has no lateral contraction; give G in place of nu, or take the law "
                  "\"solid\"");
  if (!(nu >= 0 && nu <= most))
    poisson->fail(fmt::format("{} is out of range; 0 <= nu <= {}", nu, most));
  material.nu = nu;
  for (std::size_t a = 0; a < 3; ++a) material.G[a] = material.E[a] / (2 * (1 + nu));
  if (shear) material.G = read_per_axis(*shear);
  material.damping_ratio = constants.non_negative_or("damping_ratio", 0);
  return material;
}

void read_paper_body(ObjectNode& constants, Body& body) {
  for (int a = 0; a < 3; ++a) body.axis[std::size_t(a)] = read_paper_link(constants, a);
  const auto inertia = constants.find("inertia");
  body.mass = constants.positive_or("mass", 1);
  body.inertia = inertia ? read_per_axis(*inertia) : Vec3{1, 1, 1};
}

/// Mass and inertia of an element of a material.
void read_density(ObjectNode& constants, Body& body) {
  body.mass = constants.require("rho").positive() * body.edge[0] * body.edge[1] * body.edge[2];
  body.inertia = box_inertia(body.mass, body.edge);
}

void read_material_body(ObjectNode& constants, Body& body) {
  if (constants.require_one({"E", "links"}) == "E") {
    const Material material = read_material(constants, false);
    read_density(constants, body);
    body.has_links_of_beams = true;
    const Vec3 reduced = {body.inertia[0] / 2, body.inertia[1] / 2, body.inertia[2] / 2};
    for (int a = 0; a < 3; ++a)
      body.axis[std::size_t(a)] = material_link(material, a, body.edge, body.mass / 2, reduced);
    return;
  }
  body.mass = constants.require("mass").positive();
  const auto inertia = constants.find("inertia");
  body.inertia = inertia ? read_per_axis(*inertia) : box_inertia(body.mass, body.edge);
  ObjectNode links(constants.require("links"));
  for (std::size_t a = 0; a < 3; ++a) {
    ObjectNode link(links.require(std::string(1, "xyz"[a])));
    body.axis[a] = read_explicit_link(link, int(a));
    link.finish();
  }
  links.finish();
}

/// A material with the same constants along every axis. With G in place of nu there is no lateral
/// contraction.
Material read_solid_material(ObjectNode& constants) {
  for (const char* key : {"E", "G"})
    if (const auto value = constants.find(key); value && value->is_array())
      value->fail("a solid has one E and one G, the same along every axis");
  return read_material(constants, true);
}

/// {"1": {"E", "nu", "rho"}, "2": ...}: by the numbers of the voxels.
BodyMaterials read_materials(const Node& node, const std::vector<int>& numbers, Body& body) {
  ObjectNode object(node);
  std::map<int, Material> materials;
  std::map<int, double> masses;
  for (const int number : numbers) {
    ObjectNode constants(object.require(std::to_string(number)));
    materials[number] = read_solid_material(constants);
    read_density(constants, body);
    masses[number] = body.mass;
    constants.finish();
  }
  object.finish();
  body.mass = masses.begin()->second;
  body.inertia = box_inertia(body.mass, body.edge);
  if (std::ranges::any_of(masses, [&](const auto& one) { return one.second != body.mass; })) {
    body.mass_ratios.assign(std::size_t(numbers.back()) + 1, 1);
    for (const auto& [number, mass] : masses)
      body.mass_ratios[std::size_t(number)] = mass / body.mass;
  }
  return BodyMaterials(std::move(materials));
}

} // namespace

PairOfElements pair_of_elements(const Body& from, const Body& to, int axis, double ratio_from,
                                double ratio_to) {
  const auto a = std::size_t(axis);
  const auto reduced = [&](double i, double j) {
    i *= ratio_from, j *= ratio_to;
    return i * j / (i + j);
  };
  PairOfElements pair{from.edge, reduced(from.mass, to.mass), {}};
  pair.edge[a] = (from.edge[a] + to.edge[a]) / 2;
  for (std::size_t b = 0; b < 3; ++b) pair.inertia[b] = reduced(from.inertia[b], to.inertia[b]);
  return pair;
}

double torsion_constant(double b, double c) {
  if (b < c) std::swap(b, c);
  // The series sum tanh(n pi b / 2c) / n^5 over odd n. It is computed as its limit for tanh = 1
  // minus terms that fall exponentially.
  constexpr double sum_of_odd_fifth_powers = 1.0045237627951382; // 31/32 zeta(5)
  double sum = sum_of_odd_fifth_powers;
  for (int n = 1; n < 25; n += 2)
    sum -= 2 / (std::pow(n, 5) * (std::exp(n * std::numbers::pi * b / c) + 1));
  return b * c * c * c * (1.0 / 3 - 64 / std::pow(std::numbers::pi, 5) * (c / b) * sum);
}

Vec3 box_inertia(double mass, const Vec3& edge) {
  const Vec3 square = {edge[0] * edge[0], edge[1] * edge[1], edge[2] * edge[2]};
  return {mass / 12 * (square[1] + square[2]), mass / 12 * (square[0] + square[2]),
          mass / 12 * (square[0] + square[1])};
}

AxisConstants material_link(const Material& material, int axis, const Vec3& edge, double mass,
                            const Vec3& inertia) {
  const auto a = std::size_t(axis);
  const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
  const double length = edge[a], area = edge[b] * edge[c], E = material.E[a], G = material.G[a];
  AxisConstants link;
  link.k_normal = E * area / length;
  link.k_shear = across(axis, G * area / length);
  link.k_rot[a] = G * torsion_constant(edge[b], edge[c]) / length;
  link.k_rot[b] = E * edge[b] * std::pow(edge[c], 3) / 12 / length;
  link.k_rot[c] = E * edge[c] * std::pow(edge[b], 3) / 12 / length;
  set_damping(material.damping_ratio, mass, inertia, link);
  return link;
}

void set_damping(double ratio, double mass, const Vec3& inertia, AxisConstants& link) {
  const auto damping = [&](double k, double m) { return 2 * ratio * std::sqrt(k * m); };
  link.d_normal = damping(link.k_normal, mass);
  for (std::size_t i = 0; i < 3; ++i) {
    link.d_shear[i] = damping(link.k_shear[i], mass);
    link.d_rot[i] = damping(link.k_rot[i], inertia[i]);
  }
}

BodyMaterials read_body_constants(const Node& node, const std::vector<int>& numbers, Body& body) {
  ObjectNode constants(node);
  const auto law = constants.require("law").choice("law", law_names);
  body.law = law == paper ? LinkLaw::paper : LinkLaw::material;
  const auto materials = constants.find("materials");
  if (materials && law != solid)
    materials->fail("bodies of several materials have the law \"solid\"");
  if (numbers.size() > 1 && !materials)
    constants.fail(fmt::format("the voxels have {} materials, {} to {}; give the constants of each "
                               "in \"materials\", with the law \"solid\"",
                               numbers.size(), numbers.front(), numbers.back()));
  BodyMaterials of_solid;
  if (law == paper) read_paper_body(constants, body);
  if (law == material) read_material_body(constants, body);
  if (law == solid && materials) of_solid = read_materials(*materials, numbers, body);
  if (law == solid && !materials) {
    of_solid = read_solid_material(constants);
    read_density(constants, body);
  }
  constants.finish();
  return of_solid;
}

std::optional<Material> read_link_constants(const Node& node, const Body& from, const Body& to,
                                            ExtraLink& link) {
  ObjectNode constants(node);
  const auto law = constants.require("law").choice("law", law_names);
  link.law = law == paper ? LinkLaw::paper : LinkLaw::material;
  std::optional<Material> of_solid;
  if (law == solid) {
    of_solid = read_solid_material(constants);
    if (of_solid->nu > 0)
      constants.require("nu").fail("an extra link passes no pressure on; give G in place of nu");
  } else if (law == paper) {
    link.constants = read_paper_link(constants, link.axis);
  } else if (constants.require_one({"E", "k_normal"}) == "E") {
    const PairOfElements pair = pair_of_elements(from, to, link.axis);
    link.constants = material_link(read_material(constants, false), link.axis, pair.edge, pair.mass,
                                   pair.inertia);
  } else {
    link.constants = read_explicit_link(constants, link.axis);
  }
  constants.finish();
  return of_solid;
}

} // namespace dss
