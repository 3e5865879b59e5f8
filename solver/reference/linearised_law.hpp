#pragma once
/// Links between elements that turn little, for Rotation::linearised. Both laws of link_law.hpp are
/// the same to first order in displacements and turns.
#include "solver/reference/link_law.hpp"

namespace dss::reference {

/// Normal and shear constants as one factor for each axis.
template <class T>
Vector<T> across_and_along(int axis, T normal, const Vector<T>& shear) {
  Vector<T> both = shear;
  both[axis] = normal;
  return both;
}

/// Rotational constants [N m/rad]; the paper's law is isotropic.
template <class T>
Vector<T> rotational(const LinkProperties<T>& link, const Vector<T>& constants) {
  return link.law == LinkLaw::paper ? Vector<T>::Constant(constants[0]) : constants;
}

/// Reaction with A - I = [theta]x in the gap; body axes and arms do not turn elsewhere. It is
/// linear in the motions, so its elastic part has a quadratic energy. q of a motion is (0, theta /
/// 2), so the formulas of small turns apply.
template <class T>
Reaction<T> linearised_reaction(const Motion<T>& i, const Motion<T>& j,
                                const LinkProperties<T>& link) {
  const Vector<T> rate = (j.v - i.v) - i.w.cross(link.arm_i) - j.w.cross(link.arm_j);
  const Vector<T> force =
      across_and_along(link.axis, link.k_normal, link.k_shear).cwiseProduct(gap(i, j, link)) +
      across_and_along(link.axis, link.d_normal, link.d_shear).cwiseProduct(rate);
  const Vector<T> torque = T(2) * rotational(link, link.k_rot).cwiseProduct(j.q.v - i.q.v) +
                           rotational(link, link.d_rot).cwiseProduct(j.w - i.w);
  return {force, link.arm_i.cross(force) + torque, link.arm_j.cross(force) - torque};
}

/// Potential energy of the elastic part [J].
template <class T>
T linearised_energy(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link) {
  const Vector<T> d = gap(i, j, link), turn = T(2) * (j.q.v - i.q.v);
  return (d.dot(across_and_along(link.axis, link.k_normal, link.k_shear).cwiseProduct(d)) +
          turn.dot(rotational(link, link.k_rot).cwiseProduct(turn))) /
         T(2);
}

} // namespace dss::reference
