#pragma once
/// Constants of a link in the form of the shared laws (kernels/link_force/link_force.h). `Law` is
/// any struct with the laws' field names.
#include "solver/model/problem.hpp"

namespace dss {

/// Material law. Rotational stiffnesses are doubled. Normal constants are stored minus shear, those
/// about x and y minus the one about z.
template <class Law>
void set_material_constants(Law& law, const AxisConstants& a) {
  using T = decltype(law.k_s);
  law.k_s = T(a.k_shear), law.k_ns = T(a.k_normal - a.k_shear);
  law.d_s = T(a.d_shear), law.d_ns = T(a.d_normal - a.d_shear);
  law.k_z = T(2 * a.k_rot[2]), law.k_xz = T(2 * (a.k_rot[0] - a.k_rot[2])),
  law.k_yz = T(2 * (a.k_rot[1] - a.k_rot[2]));
  law.d_z = T(a.d_rot[2]), law.d_xz = T(a.d_rot[0] - a.d_rot[2]),
  law.d_yz = T(a.d_rot[1] - a.d_rot[2]);
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
