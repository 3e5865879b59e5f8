#pragma once
/// Links of the law `solid`: a body of any number of layers is as stiff as its material.
#include "solver/model/thickness.hpp"
#include "solver/scene/constants.hpp"

#include <map>
#include <optional>
#include <vector>

namespace dss {

/// What of a scene has the law `solid`.
struct Solids {
  std::vector<std::optional<Material>> bodies; ///< of each body
  std::map<std::size_t, Material> extra_links; ///< by their numbers
};

/// Constants of a link along `axis` between elements i and j. An element of several layers is free
/// to turn by half of the shear, so the links along both axes share the shear in series, and each
/// has twice the stiffness of a single layer. With A the face, L the distance of the centres and d
/// the axis of the gap:
///   k_normal = E A / L,  k_shear[d] = 4 G A / L / (c_i + c_j),
///   bending E I / L,  twist G (J_i + J_j) / 2 / L
/// c is 1, or 2.4 if the element is thin along d: then the stiffness is that of a beam's or plate's
/// section, 5/6 G A / L. J is h_max h_min^3 / 6 of the edges across; of an element thin along one
/// of them h_other h_d^3 / 6; of one thin along both the torsion constant of the rectangle.
/// README.md of this folder says why. The study `continuum` and tests/unit/solid_test.cpp check it.
/// @param edge, mass, inertia  as in material_link
AxisConstants solid_link(const Material& material, int axis, const Vec3& edge, ThinAxes i,
                         ThinAxes j, double mass, const Vec3& inertia);

/// Sets the links of all solids. The lattice and the extra links must be complete: an element with
/// an extra link of a solid has a neighbour there.
void set_solid_links(const Solids& solids, Problem& problem);

} // namespace dss
