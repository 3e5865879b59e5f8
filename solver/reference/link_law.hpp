#pragma once
/// The two link laws of DESIGN.md section 2 as the oracle computes them, and the potential energy
/// of their elastic parts.
#include "solver/model/problem.hpp"
#include "solver/reference/orientation.hpp"

namespace dss::reference {

/// Motion of one element in the global frame.
template <class T>
struct Motion {
  Vector<T> u, v, w; ///< displacement [m], velocity [m/s], angular velocity [rad/s]
  Orientation<T> q;
  Matrix<T> turned; ///< A - I
  Matrix<T> rotation() const { return Matrix<T>::Identity() + turned; }
};

/// Constants of a link in T. The arms are in body axes: arm_i points from the centre of i to its
/// face, arm_j from the face of j to its centre.
template <class T>
struct LinkProperties {
  LinkLaw law = LinkLaw::paper;
  int axis = 0;
  Vector<T> arm_i, arm_j;     ///< half edges along +axis [m]
  T k_normal, d_normal;       ///< [N/m], [N s/m]
  Vector<T> k_shear, d_shear; ///< as in AxisConstants [N/m], [N s/m]
  Vector<T> k_rot, d_rot;     ///< [N m/rad], [N m s/rad]
  T area = 0;                 ///< of the face, if pressures act on it; else 0 [m^2]
};

/// Forces and moments of a link on its two elements.
template <class T>
struct Reaction {
  Vector<T> force;              ///< on i; on j the negative force [N]
  Vector<T> moment_i, moment_j; ///< about the centres of the elements [N m]
};

/// Gap D of the link between its two face points, global frame [m]; zero at rest.
template <class T>
Vector<T> gap(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link) {
  return (j.u - i.u) - i.turned * link.arm_i - j.turned * link.arm_j;
}

/// The paper's law, computed as in the paper. Gap and rate are rotated into the frame of element i;
/// the force is found there, each moment in its own element's frame, and all are rotated back. The
/// law is isotropic: it uses k_normal, d_normal, k_rot[0] and d_rot[0].
template <class T>
Reaction<T> paper_reaction(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link) {
  const Matrix<T> a_i = i.rotation(), a_j = j.rotation();
  const Vector<T> local_gap = a_i.transpose() * gap(i, j, link);
  const Vector<T> point_velocity_i = Vector<T>(a_i.transpose() * i.w).cross(link.arm_i);
  const Vector<T> point_velocity_j = Vector<T>(a_j.transpose() * j.w).cross(link.arm_j);
  const Vector<T> local_rate =
      a_i.transpose() * Vector<T>(j.v - i.v - a_j * point_velocity_j) - point_velocity_i;
  const Vector<T> local_force = link.k_normal * local_gap + link.d_normal * local_rate;
  const Vector<T> torque =
      T(2) * link.k_rot[0] * relative_vector(i.q, j.q) + link.d_rot[0] * (j.w - i.w);

  Reaction<T> reaction;
  reaction.force = a_i * local_force;
  reaction.moment_i = a_i * link.arm_i.cross(local_force) + torque;
  reaction.moment_j = a_j * link.arm_j.cross(Vector<T>(a_j.transpose() * reaction.force)) - torque;
  return reaction;
}

/// Rotation from i to j: (p0, r) = q_j conj(q_i).
template <class T>
struct RelativeRotation {
  Vector<T> r;
  T p0;
};
template <class T>
RelativeRotation<T> relative_rotation(const Motion<T>& i, const Motion<T>& j) {
  return {relative_vector(i.q, j.q), relative_scalar(i.q, j.q)};
}

/// Moment on i of the rotational springs of the material law [N m]. It is minus the derivative of
/// their energy (elastic_energy) by a turn of i.
template <class T>
Vector<T> material_spring_torque(const Motion<T>& i, const Motion<T>& j, const Matrix<T>& mean,
                                 const LinkProperties<T>& link,
                                 const RelativeRotation<T>& relative) {
  const Vector<T>& r = relative.r;
  const T p0 = relative.p0;
  Vector<T> torque = T(2) * link.k_rot.z() * r;
  for (const int m : {0, 1}) {
    const Vector<T> n = mean.col(m);
    const Vector<T> spread = i.turned.col(m) - j.turned.col(m); // n_mi - n_mj
    torque +=
        T(2) * (link.k_rot[m] - link.k_rot.z()) * n.dot(r) * (p0 * n + r.cross(spread) / T(2));
  }
  return torque;
}

/// The material law: orthotropic about the columns of the mean rotation. It acts at the common
/// point, half-way across the gap.
template <class T>
Reaction<T> material_reaction(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link,
                              const RelativeRotation<T>& relative) {
  const Matrix<T> mean = Matrix<T>::Identity() + (i.turned + j.turned) / T(2);
  const Vector<T> d = gap(i, j, link);
  const Vector<T> b_i = i.rotation() * link.arm_i + d / T(2);
  const Vector<T> b_j = j.rotation() * link.arm_j + d / T(2);
  const Vector<T> rate = (j.v - i.v) - i.w.cross(b_i) - j.w.cross(b_j);
  const Vector<T> spin = j.w - i.w;
  const auto [base, third] = shear_axes(link.axis);
  const T k_base = link.k_shear[Eigen::Index(base)], d_base = link.d_shear[Eigen::Index(base)];
  Vector<T> force = k_base * d + d_base * rate;
  // The directions turn with both elements, so a gap across one causes a couple besides that of
  // the force.
  Vector<T> gap_couple = Vector<T>::Zero();
  const auto add = [&](Eigen::Index m, T k, T damping) {
    const Vector<T> n = mean.col(m), spread = i.turned.col(m) - j.turned.col(m);
    const T pull = (k - k_base) * n.dot(d);
    force += pull * n + (damping - d_base) * n.dot(rate) * n;
    gap_couple += pull / T(4) * d.cross(spread);
  };
  add(link.axis, link.k_normal, link.d_normal);
  add(Eigen::Index(third), link.k_shear[Eigen::Index(third)], link.d_shear[Eigen::Index(third)]);

  Vector<T> torque = material_spring_torque(i, j, mean, link, relative) + link.d_rot.z() * spin;
  for (const int m : {0, 1}) {
    const Vector<T> n_m = mean.col(m);
    torque += (link.d_rot[m] - link.d_rot.z()) * n_m.dot(spin) * n_m;
  }
  return {force, b_i.cross(force) + gap_couple + torque, b_j.cross(force) - gap_couple - torque};
}

/// Reaction of a link by its own law.
template <class T>
Reaction<T> reaction(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link) {
  return link.law == LinkLaw::paper ? paper_reaction(i, j, link)
                                    : material_reaction(i, j, link, relative_rotation(i, j));
}

/// Potential energy of a link's elastic part [J]:
///     paper     1/2 k D.D + 4 kt (1 - p0)
///     material  1/2 k_s D.D + 1/2 (k_n - k_s)(n_a.D)^2 + 1/2 (k_t - k_s)(n_t.D)^2
///               + 4 k_z (1 - p0) + 2 (k_x - k_z)(n_x.r)^2 + 2 (k_y - k_z)(n_y.r)^2
/// with (p0, r) = q_j conj(q_i); n_m are the columns of the mean rotation matrix, n_a that of the
/// link's axis. k_s and k_t are the shear constants along the axes of shear_axes.
template <class T>
T elastic_energy(const Motion<T>& i, const Motion<T>& j, const LinkProperties<T>& link) {
  const Vector<T> d = gap(i, j, link);
  const T versine = relative_versine(i.q, j.q);
  if (link.law == LinkLaw::paper)
    return link.k_normal * d.squaredNorm() / T(2) + T(4) * link.k_rot[0] * versine;

  const Matrix<T> mean = Matrix<T>::Identity() + (i.turned + j.turned) / T(2);
  const Vector<T> r = relative_vector(i.q, j.q);
  const auto [base, third] = shear_axes(link.axis);
  const T k_s = link.k_shear[Eigen::Index(base)], k_t = link.k_shear[Eigen::Index(third)];
  const T stretch = mean.col(link.axis).dot(d), slide = mean.col(Eigen::Index(third)).dot(d);
  T energy = (k_s * d.squaredNorm() + (link.k_normal - k_s) * stretch * stretch +
              (k_t - k_s) * slide * slide) /
                 T(2) +
             T(4) * link.k_rot.z() * versine;
  for (const int m : {0, 1}) {
    const T bend = mean.col(m).dot(r);
    energy += T(2) * (link.k_rot[m] - link.k_rot.z()) * bend * bend;
  }
  return energy;
}

} // namespace dss::reference
