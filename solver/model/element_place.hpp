#pragma once
/// Places in rigid elements, and their motion.
#include "kernels/fields.hpp"
#include "solver/model/problem.hpp"

#include <array>

namespace dss {

/// (A - I) c = 2 q0 r x c + 2 r x (r x c), with the quaternion (q0, r) of the fields.
inline Vec3 turned_by(const double* fields, const Vec3& c) {
  const double w = 1 + fields[qs], x = fields[qx], y = fields[qy], z = fields[qz];
  const Vec3 t = {y * c[2] - z * c[1], z * c[0] - x * c[2], x * c[1] - y * c[0]};
  return {2 * (w * t[0] + y * t[2] - z * t[1]), 2 * (w * t[1] + z * t[0] - x * t[2]),
          2 * (w * t[2] + x * t[1] - y * t[0])};
}

/// Displacement of the end of an arm from the centre [m]: u + (A - I) c.
/// @param fields  of the element (kernels/fields.hpp)
inline Vec3 displacement_at(const double* fields, const Vec3& arm) {
  const Vec3 turned = turned_by(fields, arm);
  return {fields[ux] + turned[0], fields[uy] + turned[1], fields[uz] + turned[2]};
}

/// Its velocity [m/s]: v + w x A c.
inline Vec3 velocity_at(const double* fields, const Vec3& arm) {
  Vec3 c = turned_by(fields, arm);
  for (std::size_t a = 0; a < 3; ++a) c[a] += arm[a];
  const double* w = fields + wx;
  return {fields[vx] + w[1] * c[2] - w[2] * c[1], fields[vy] + w[2] * c[0] - w[0] * c[2],
          fields[vz] + w[0] * c[1] - w[1] * c[0]};
}

/// The place in a body's elements that is nearest to a point.
struct NearestPlace {
  std::size_t element = 0;   ///< of several that are equally near, the first
  std::array<int, 3> cell{}; ///< of the body's grid
  Vec3 centre{}, arm{};      ///< of the element; from there to the place [m]
  double distance = 0;       ///< from the point; 0 if it is in the body [m]
};
/// @param body   index
/// @param point  at rest [m]
NearestPlace nearest_place(const Problem& problem, int body, const Vec3& point);

} // namespace dss
