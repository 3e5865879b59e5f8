#pragma once
/// Constants of elements and links, as published (`paper`) or from a material (`material`, `solid`;
/// DESIGN.md section 2).
#include "solver/json/object_node.hpp"
#include "solver/model/problem.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace dss {

/// Elastic constants of a link along each axis, and its damping.
struct Material {
  Vec3 E{}, G{}; ///< [Pa], of links along x, y, z; all equal for an isotropic material
  /// Damping ratio of each single spring, with the reduced mass or inertia of two elements.
  double damping_ratio = 0;
  /// Poisson's ratio of a solid: 0 if G is given, because a body then has no lateral contraction.
  double nu = 0;
};

/// The materials of a body of the law `solid`, by their numbers in its voxels.
class BodyMaterials {
public:
  BodyMaterials() = default;                                     ///< none: the body has another law
  BodyMaterials(const Material& only) : materials_{{1, only}} {} // of most bodies
  explicit BodyMaterials(std::map<int, Material> materials) : materials_(std::move(materials)) {}

  bool is_solid() const { return !materials_.empty(); }
  std::size_t count() const { return materials_.size(); }
  /// @param number  of any voxel if there is one material
  const Material& of(int number) const {
    return count() == 1 ? materials_.begin()->second : materials_.at(number);
  }
  /// Whether an element of some material has a pressure.
  bool is_contracting() const {
    return std::ranges::any_of(materials_, [](const auto& one) { return one.second.nu > 0; });
  }
  const std::map<int, Material>& all() const { return materials_; }

private:
  std::map<int, Material> materials_;
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

/// Sets the dampers of a link: d = 2 ratio sqrt(k m) beside each spring.
/// @param mass, inertia  as in material_link
void set_damping(double ratio, double mass, const Vec3& inertia, AxisConstants& link);

/// What a joint of two bodies joins. The distance of the centres is the sum of two half edges, the
/// face is that of the first body, mass and inertia are the reduced ones.
struct PairOfElements {
  Vec3 edge; ///< [m]
  double mass;
  Vec3 inertia;
};
/// @param ratio_from, ratio_to  of the elements' masses to those of their bodies
PairOfElements pair_of_elements(const Body& from, const Body& to, int axis, double ratio_from = 1,
                                double ratio_to = 1);

/// Fills law, mass, inertia and axis of a body. Its edges must be set.
/// @param numbers  of the materials of its voxels, ascending
/// @return the materials of a solid, whose links are set later (solid.hpp)
BodyMaterials read_body_constants(const Node& node, const std::vector<int>& numbers, Body& body);

/// Fills law and constants of a link between elements of two bodies. Its axis must be set.
/// @return the material of a solid, whose constants are set later
std::optional<Material> read_link_constants(const Node& node, const Body& from, const Body& to,
                                            ExtraLink& link);

} // namespace dss
