#pragma once
/// Links of Rotation::small: rotations are vectors that add up, A = I + [theta]x. Both laws of
/// link_law.hpp, with products kept. q of a motion is (0, theta / 2).
#include "solver/reference/link_law.hpp"

namespace dss::reference {

/// The paper's law in the global frame. A is not a rotation matrix here, so it cannot take a vector
/// into another frame and back.
template <class T>
Reaction<T> small_paper_reaction(const Motion<T>& i, const Motion<T>& j,
                                 const LinkProperties<T>& link) {
  const Vector<T> a_i = i.rotation() * link.arm_i, a_j = j.rotation() * link.arm_j;
  const Vector<T> rate = (j.v - i.v) - i.w.cross(a_i) - j.w.cross(a_j);
  const Vector<T> force = link.k_normal * gap(i, j, link) + link.d_normal * rate;
  const Vector<T> torque = T(2) * link.k_rot[0] * (j.q.v - i.q.v) + link.d_rot[0] * (j.w - i.w);
  return {force, a_i.cross(force) + torque, a_j.cross(force) - torque};
}

/// Reaction of a link by its own law.
template <class T>
Reaction<T> small_reaction(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link) {
  if (link.law == LinkLaw::paper) return small_paper_reaction(i, j, link);
  return material_reaction(i, j, link, RelativeRotation<T>{j.q.v - i.q.v, T(1)});
}

} // namespace dss::reference
