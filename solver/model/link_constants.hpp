#pragma once
/// Constants of a link in the form of the shared laws (kernels/link_force/link_force.h). `Law` is
/// any struct with the laws' field names.
#include "solver/model/problem.hpp"

namespace dss {

/// Material law, of a link along `axis`. Rotational stiffnesses are doubled. The normal constant
/// and that of the third axis are stored minus shear, those about x and y minus the one about z.
template <class Law>
void set_material_constants(Law& law, const AxisConstants& a, int axis) {
  using T = decltype(law.k_s);
  const auto [base, third] = shear_axes(axis);
  const double k = a.k_shear[base], d = a.d_shear[base];
  law.k_s = T(k), law.k_ns = T(a.k_normal - k), law.k_ts = T(a.k_shear[third] - k);
  law.d_s = T(d), law.d_ns = T(a.d_normal - d), law.d_ts = T(a.d_shear[third] - d);
  law.k_z = T(2 * a.k_rot[2]), law.k_xz = T(2 * (a.k_rot[0] - a.k_rot[2])),
  law.k_yz = T(2 * (a.k_rot[1] - a.k_rot[2]));
  law.d_z = T(a.d_rot[2]), law.d_xz = T(a.d_rot[0] - a.d_rot[2]),
  law.d_yz = T(a.d_rot[1] - a.d_rot[2]);
}

/// True if shear has two constants across a link along `axis`.
inline bool has_two_shears(const AxisConstants& a, int axis) {
  const auto [base, third] = shear_axes(axis);
  return a.k_shear[base] != a.k_shear[third] || a.d_shear[base] != a.d_shear[third];
}
/// True if it has so across some link of a body.
inline bool has_two_shears(const Body& body) {
  bool has = false;
  body.each_kind([&](const AxisConstants& a, int axis) { has = has || has_two_shears(a, axis); });
  return has;
}

/// Paper's law, computed in units of k.
template <class Law>
void set_paper_constants(Law& law, const AxisConstants& a) {
  using T = decltype(law.tau);
  law.tau = T(a.d_normal / a.k_normal);
  law.kt2 = T(2 * a.k_rot[0] / a.k_normal);
  law.dt = T(a.d_rot[0] / a.k_normal);
}

} // namespace dss
