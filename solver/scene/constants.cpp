#include "solver/scene/constants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dss {
namespace {

const std::vector<std::string> law_names = {"paper", "material"};

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
AxisConstants read_paper_link(ObjectNode& constants) {
  AxisConstants link;
  link.k_normal = link.k_shear = constants.positive_or("k", 1e11);
  link.d_normal = link.d_shear = constants.non_negative_or("d", 1e5);
  link.k_rot.fill(constants.non_negative_or("kt", 0));
  link.d_rot.fill(constants.non_negative_or("dt", 1e2));
  return link;
}

AxisConstants read_explicit_link(ObjectNode& constants) {
  AxisConstants link;
  link.k_normal = constants.require("k_normal").non_negative();
  link.k_shear = constants.require("k_shear").non_negative();
  link.d_normal = constants.non_negative_or("d_normal", 0);
  link.d_shear = constants.non_negative_or("d_shear", 0);
  if (const auto k_rot = constants.find("k_rot")) link.k_rot = read_non_negative_vector(*k_rot);
  if (const auto d_rot = constants.find("d_rot")) link.d_rot = read_non_negative_vector(*d_rot);
  return link;
}

Material read_material(ObjectNode& constants) {
  Material material;
  material.E = read_per_axis(constants.require("E"));
  const auto shear = constants.find("G"), poisson = constants.find("nu");
  if (shear && poisson) constants.fail("G and nu exclude each other; give one of them");
  const double nu = poisson ? poisson->number() : 0;
  if (!(nu > -1 && nu <= 0.5)) poisson->fail(fmt::format("{} is out of range; -1 < nu <= 0.5", nu));
  for (std::size_t a = 0; a < 3; ++a) material.G[a] = material.E[a] / (2 * (1 + nu));
  if (shear) material.G = read_per_axis(*shear);
  material.damping_ratio = constants.non_negative_or("damping_ratio", 0);
  return material;
}

void read_paper_body(ObjectNode& constants, Body& body) {
  body.axis.fill(read_paper_link(constants));
  const auto inertia = constants.find("inertia");
  body.mass = constants.positive_or("mass", 1);
  body.inertia = inertia ? read_per_axis(*inertia) : Vec3{1, 1, 1};
}

void read_material_body(ObjectNode& constants, Body& body) {
  if (constants.require_one({"E", "links"}) == "E") {
    const Material material = read_material(constants);
    body.mass = constants.require("rho").positive() * body.edge[0] * body.edge[1] * body.edge[2];
    body.inertia = box_inertia(body.mass, body.edge);
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
    body.axis[a] = read_explicit_link(link);
    link.finish();
  }
  links.finish();
}

/// Joint of two bodies: the distance of the centres is the sum of two half edges; the face is that
/// of the first body.
AxisConstants read_material_joint(ObjectNode& constants, const Body& from, const Body& to,
                                  int axis) {
  const Material material = read_material(constants);
  const auto a = std::size_t(axis);
  Vec3 edge = from.edge, inertia;
  edge[a] = (from.edge[a] + to.edge[a]) / 2;
  for (std::size_t b = 0; b < 3; ++b)
    inertia[b] = from.inertia[b] * to.inertia[b] / (from.inertia[b] + to.inertia[b]);
  return material_link(material, axis, edge, from.mass * to.mass / (from.mass + to.mass), inertia);
}

} // namespace

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
  link.k_shear = G * area / length;
  link.k_rot[a] = G * torsion_constant(edge[b], edge[c]) / length;
  link.k_rot[b] = E * edge[b] * std::pow(edge[c], 3) / 12 / length;
  link.k_rot[c] = E * edge[c] * std::pow(edge[b], 3) / 12 / length;
  const auto damping = [&](double k, double m) {
    return 2 * material.damping_ratio * std::sqrt(k * m);
  };
  link.d_normal = damping(link.k_normal, mass);
  link.d_shear = damping(link.k_shear, mass);
  for (std::size_t i = 0; i < 3; ++i) link.d_rot[i] = damping(link.k_rot[i], inertia[i]);
  return link;
}

void read_body_constants(const Node& node, Body& body) {
  ObjectNode constants(node);
  body.law =
      constants.require("law").choice("law", law_names) == 0 ? LinkLaw::paper : LinkLaw::material;
  if (body.law == LinkLaw::paper)
    read_paper_body(constants, body);
  else
    read_material_body(constants, body);
  constants.finish();
}

void read_link_constants(const Node& node, const Body& from, const Body& to, ExtraLink& link) {
  ObjectNode constants(node);
  link.law =
      constants.require("law").choice("law", law_names) == 0 ? LinkLaw::paper : LinkLaw::material;
  if (link.law == LinkLaw::paper)
    link.constants = read_paper_link(constants);
  else if (constants.require_one({"E", "k_normal"}) == "E")
    link.constants = read_material_joint(constants, from, to, link.axis);
  else
    link.constants = read_explicit_link(constants);
  constants.finish();
}

} // namespace dss
