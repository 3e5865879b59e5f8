#pragma once
/// Links of the law `solid`: a body of any number of layers is as stiff as its material.
#include "solver/model/thickness.hpp"
#include "solver/scene/constants.hpp"

#include <array>
#include <map>
#include <vector>

namespace dss {

/// What of a scene has the law `solid`.
struct Solids {
  std::vector<BodyMaterials> bodies;           ///< of each body
  std::map<std::size_t, Material> extra_links; ///< by their numbers
};

/// Constants of a link along `axis` between elements i and j. An element of several layers is free
/// to turn by half of the shear, so the links along both axes share the shear in series, and each
/// has twice the stiffness of a single layer. With A the face, L the distance of the centres and d
/// the axis of the gap:
///   k_normal = (M_i + M_j) / 2 A / L,  k_shear[d] = 4 G A / L / (c_i + c_j),
///   bending (M_i + M_j) / 2 I / L,  twist G (J_i + J_j) / 2 / L
/// Across two materials the halves of the link are in series, each as stiff as half of a link of
/// its own material.
/// M is 2G, because the pressure of elements has the rest of the stiffness (element_pressure); it
/// is E if nu is 0, or if the element is thin along two axes, as in a chain.
/// c is 1, or 2.4 if the element is thin along d: then the stiffness is that of a beam's or plate's
/// section, 5/6 G A / L. J is h_max h_min^3 / 6 of the edges across; of an element thin along one
/// of them h_other h_d^3 / 6; of one thin along both the torsion constant of the rectangle.
/// README.md of this folder says why. The study `continuum` and tests/unit/solid_test.cpp check it.
/// @param edge, mass, inertia  as in material_link
AxisConstants solid_link(const Material& material, int axis, const Vec3& edge, ThinAxes i,
                         ThinAxes j, double mass, const Vec3& inertia);

/// Pressure of an element with nu > 0. With lambda = 2 G nu / (1 - 2 nu) and n free faces, whose
/// half links are eliminated exactly,
///   volume = lambda / (1 + n lambda / 4G)
///   bending[o] = h_o^2 / 12 lambda / (1 + (2 + m) lambda / 4G)   if it is thin along o alone
/// m: free faces across the other axes. That is plane stress with two free faces; an element thin
/// along two axes has no pressure.
/// @param free  free faces across x, y, z, each 0 to 2
ElementPressure element_pressure(const Material& material, const Vec3& edge,
                                 const std::array<int, 3>& free, ThinAxes thin);

/// Sets Load::face_strain of a load that acts on free faces of a solid (Load::face).
/// @param material  of its elements
/// @param edge      of an element of its body [m]
void set_face_strain(const Material& material, const Vec3& edge, Load& load);

/// Sets the links of all solids and the pressures of their elements. The lattice and the extra
/// links must be complete: an element with an extra link of a solid has a neighbour there.
/// @throws InputError if the materials of a body make more kinds of links or pressures than a byte
///     counts
void set_solid_links(const Solids& solids, Problem& problem);

} // namespace dss
