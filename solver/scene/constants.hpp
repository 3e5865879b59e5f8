#pragma once
/// Constants of elements and links, as published (`paper`) or from a material (DESIGN.md section
/// 2).
#include "solver/json/object_node.hpp"
#include "solver/model/problem.hpp"

namespace dss {

/// Elastic constants of a link along each axis, and its damping.
struct Material {
  Vec3 E{}, G{}; ///< [Pa], of links along x, y, z; all equal for an isotropic material
  /// Damping ratio of each single spring, with the reduced mass or inertia of two elements.
  double damping_ratio = 0;
};

/// Torsion constant [m^4] of a rectangle with sides b and c [m], to rounding. Source: Timoshenko
/// and Goodier, Theory of Elasticity, 3rd ed., section 109.
double torsion_constant(double b, double c);

/// Principal moments [kg m^2] of a homogeneous box of mass m [kg] with the given edges [m].
Vec3 box_inertia(double mass, const Vec3& edge);

/// Constants of a link along `axis` between two elements. Their centres are edge[axis] apart, and
/// their faces have the two other edges.
///   k_normal = E A / L,  k_shear = G A / L,  twist G J / L,  bending E I / L,  d = 2 zeta sqrt(k
///   m)
/// @param mass, inertia  reduced ones of the pair [kg], [kg m^2]: half of an element's if both are
///     alike
AxisConstants material_link(const Material& material, int axis, const Vec3& edge, double mass,
                            const Vec3& inertia);

/// Fills law, mass, inertia and axis of a body. Its edges must be set.
void read_body_constants(const Node& node, Body& body);

/// Fills law and constants of a link between elements of two bodies. Its axis must be set.
void read_link_constants(const Node& node, const Body& from, const Body& to, ExtraLink& link);

} // namespace dss
