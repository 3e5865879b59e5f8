#pragma once
/// Rotations of the models that store them as vectors (has_rotation_vectors). The fields qx .. qz
/// of their rows hold r, half the rotation vector. States that leave the model have unit
/// quaternions: q = (cos |r| - 1, sin |r| / |r| r).
#include "kernels/fields.hpp"

#include <cmath>
#include <span>

namespace dss {

/// Converts the 13 fields of an element from the quaternion to r, in place; qs becomes 0. Valid for
/// angles up to 360 degrees.
inline void to_rotation_vector(std::span<double> fields) {
  const double sine = std::hypot(fields[qx], fields[qy], fields[qz]);
  const double scale = sine == 0 ? 1 : std::atan2(sine, 1 + fields[qs]) / sine;
  fields[qs] = 0;
  for (const Field f : {qx, qy, qz}) fields[f] *= scale;
}

/// Converts the 13 fields of an element from r to the quaternion, in place.
inline void to_quaternion(std::span<double> fields) {
  const double a2 = fields[qx] * fields[qx] + fields[qy] * fields[qy] + fields[qz] * fields[qz];
  double scale;
  // Series of sin a / a and cos a - 1; their error is below half a unit in the last place.
  if (a2 < 1e-4) {
    scale = 1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42));
    fields[qs] = -a2 / 2 * (1 - a2 / 12 * (1 - a2 / 30 * (1 - a2 / 56)));
  } else {
    const double angle = std::sqrt(a2), half_sine = std::sin(angle / 2);
    scale = std::sin(angle) / angle;
    fields[qs] = -2 * half_sine * half_sine;
  }
  for (const Field f : {qx, qy, qz}) fields[f] *= scale;
}

/// Converts rates of r to rates of the quaternion, in place.
/// @param fields  a state that holds r
/// @param rates   rates of all 13 fields
inline void to_quaternion_rates(std::span<const double> fields, std::span<double> rates) {
  const double angle = std::hypot(fields[qx], fields[qy], fields[qz]);
  const double along = fields[qx] * rates[qx] + fields[qy] * rates[qy] + fields[qz] * rates[qz];
  const double scale = angle == 0 ? 1 : std::sin(angle) / angle;
  // (cos a - sin a / a) / a^2; a series for small angles, where the subtraction would cancel
  const double slope =
      angle < 1e-3 ? angle * angle / 30 - 1.0 / 3.0 : (std::cos(angle) - scale) / (angle * angle);
  rates[qs] = -scale * along;
  for (const Field f : {qx, qy, qz}) rates[f] = scale * rates[f] + slope * along * fields[f];
}

} // namespace dss
