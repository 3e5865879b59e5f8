#pragma once
/// Pressure of elements of a solid with nu > 0 (`ElementPressure`). It couples all links of an
/// element, by the energy
///   W = V (volume S^2 / 2 + sum over o = x, y, z of bending_o C_o^2 / 2)
///   S = 1/2 sum of e + load,   C_o = 1/2 sum of +-g_m over the links not along o
/// e = n_a.D / L is the strain of a link along a; g_m = 2 n_m.r / L is its curvature about the mean
/// axis m, which is across a and o, with the sign of (o x a).m; `load` is Load::face_strain.
/// Symbols and virtual work are those of the material law (link_law.hpp).
#include "solver/reference/link_law.hpp"

namespace dss::reference {

/// Strain of a link along its axis, and its curvature about the mean axes [1/m].
template <class T>
struct LinkStrain {
  T along = 0;
  Vector<T> curvature = Vector<T>::Zero();
};

/// What the pressures of its two elements add to a link.
template <class T>
struct LinkPressure {
  T tension = 0;                        ///< along the mean axis of the link [N]
  Vector<T> moment = Vector<T>::Zero(); ///< about the mean axes [N m]
};

/// Strains S and C of an element; or, times its constants, its pressure [Pa] and moments [N/m].
template <class T>
struct ElementStrain {
  T volume = 0;
  Vector<T> curvature = Vector<T>::Zero();
};

/// The axis across both, and the sign of (o x a) along it.
struct AcrossBoth {
  Eigen::Index axis;
  int sign;
};
constexpr AcrossBoth across_both(int o, int a) { return {3 - o - a, (o + 1) % 3 == a ? 1 : -1}; }

/// Adds a link along `axis` to the strain of one of its elements.
template <class T>
void add_link(int axis, const LinkStrain<T>& link, ElementStrain<T>& strain) {
  strain.volume += link.along / T(2);
  for (int o = 0; o < 3; ++o) {
    if (o == axis) continue;
    const auto [m, sign] = across_both(o, axis);
    strain.curvature[o] += T(sign) * link.curvature[m] / T(2);
  }
}

/// @param area  of the link's face [m^2]
template <class T>
LinkPressure<T> pressure_on_link(int axis, T area, const ElementStrain<T>& i,
                                 const ElementStrain<T>& j) {
  LinkPressure<T> link;
  link.tension = area * (i.volume + j.volume) / T(2);
  for (int o = 0; o < 3; ++o) {
    if (o == axis) continue;
    const auto [m, sign] = across_both(o, axis);
    link.moment[m] += T(sign) * area * (i.curvature[o] + j.curvature[o]) / T(2);
  }
  return link;
}

/// Gap of a link over its length, along the mean axes [1]: the strain along the link, and the shear
/// that it takes across it.
template <class T>
Vector<T> link_stretch(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link) {
  const Matrix<T> mean = Matrix<T>::Identity() + (i.turned + j.turned) / T(2);
  return mean.transpose() * gap(i, j, link) / (link.arm_i[link.axis] + link.arm_j[link.axis]);
}
/// The same to first order in displacements and rotations.
template <class T>
Vector<T> linearised_stretch(const Motion<T>& i, const Motion<T>& j,
                             const LinkProperties<T>& link) {
  return gap(i, j, link) / (link.arm_i[link.axis] + link.arm_j[link.axis]);
}

/// @param relative  rotation from i to j in the present equations
template <class T>
LinkStrain<T> link_strain(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link,
                          const Vector<T>& relative) {
  const Matrix<T> mean = Matrix<T>::Identity() + (i.turned + j.turned) / T(2);
  const T length = link.arm_i[link.axis] + link.arm_j[link.axis];
  return {link_stretch(i, j, link)[link.axis], T(2) * (mean.transpose() * relative) / length};
}
/// The same to first order in displacements and rotations.
template <class T>
LinkStrain<T> linearised_strain(const Motion<T>& i, const Motion<T>& j,
                                const LinkProperties<T>& link) {
  const T length = link.arm_i[link.axis] + link.arm_j[link.axis];
  return {linearised_stretch(i, j, link)[link.axis], T(2) * (j.q.v - i.q.v) / length};
}

/// Forces and moments of the pressures on a link: minus the derivative of W.
template <class T>
Reaction<T> pressure_reaction(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link,
                              const RelativeRotation<T>& relative,
                              const LinkPressure<T>& pressure) {
  const Matrix<T> mean = Matrix<T>::Identity() + (i.turned + j.turned) / T(2);
  const Matrix<T> spread = i.turned - j.turned;
  const Vector<T> d = gap(i, j, link);
  const Vector<T> force = pressure.tension * mean.col(link.axis);
  const Vector<T> b_i = i.rotation() * link.arm_i + d / T(2);
  const Vector<T> b_j = j.rotation() * link.arm_j + d / T(2);
  Vector<T> couple =
      pressure.tension / T(4) * d.cross(Vector<T>(spread.col(link.axis))); // as in gap_couple
  for (int m = 0; m < 3; ++m)
    couple += pressure.moment[m] *
              (relative.p0 * mean.col(m) + relative.r.cross(Vector<T>(spread.col(m))) / T(2));
  return {force, b_i.cross(force) + couple, b_j.cross(force) - couple};
}
/// The same to first order in displacements and rotations.
template <class T>
Reaction<T> linearised_pressure_reaction(const LinkProperties<T>& link,
                                         const LinkPressure<T>& pressure) {
  const Vector<T> force = pressure.tension * Vector<T>::Unit(link.axis);
  return {force, pressure.moment, -pressure.moment}; // the arms are along the force
}

} // namespace dss::reference
