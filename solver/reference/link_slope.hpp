#pragma once
/// Derivatives of what a link does by the motions of its two elements. They are exact to rounding:
/// the laws of the oracle run on numbers that carry their derivatives.
#include "solver/model/rotation.hpp"
#include "solver/reference/pressure.hpp"

#include <Eigen/Core>

namespace dss::reference {

/// The same in numbers of another type.
template <class To, class From>
Motion<To> cast(const Motion<From>& from) {
  return {from.u.template cast<To>(),
          from.v.template cast<To>(),
          from.w.template cast<To>(),
          {To(from.q.s), from.q.v.template cast<To>()},
          from.turned.template cast<To>()};
}
template <class To, class From>
LinkProperties<To> cast(const LinkProperties<From>& from) {
  return {from.law,
          from.axis,
          from.arm_i.template cast<To>(),
          from.arm_j.template cast<To>(),
          To(from.k_normal),
          To(from.d_normal),
          from.k_shear.template cast<To>(),
          from.d_shear.template cast<To>(),
          from.k_rot.template cast<To>(),
          from.d_rot.template cast<To>(),
          To(from.area)};
}
template <class To, class From>
LinkPressure<To> cast(const LinkPressure<From>& from) {
  return {To(from.tension), from.moment.template cast<To>()};
}

/// A link between two moving elements.
struct MovingLink {
  Rotation rotation;
  Motion<double> i, j;
  LinkProperties<double> properties;
};

/// How motions depend on the twelve variables (x_i, theta_i, x_j, theta_j): displacements [m] and
/// turns about axes in space [rad] by `moved`, velocities and angular velocities by `sped` times
/// the variable.
struct Variation {
  double moved = 1, sped = 0;
};

/// Derivative of the forces and moments (on i, on j) of a link.
/// @param pressure  that acts on it too, held constant; null: none
Eigen::Matrix<double, 12, 12> reaction_slope(const MovingLink& link,
                                             const LinkPressure<double>* pressure,
                                             const Variation& variation);

/// Derivative of what a link adds to the strain of each of its elements: volume, then curvatures.
Eigen::Matrix<double, 4, 12> strain_slope(const MovingLink& link, const Variation& variation);

} // namespace dss::reference
