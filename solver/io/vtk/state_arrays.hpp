#pragma once
/// The arrays of a state that files of VTK have, whatever the format.
#include "kernels/fields.hpp"
#include "solver/io/vtk/node_motion.hpp"
#include "solver/io/vtk/stress_output.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace dss {

/// Corners of VTK_HEXAHEDRON in VTK's order, as ElementNodes numbers them.
constexpr std::array<std::size_t, 8> vtk_corners = {0, 1, 3, 2, 4, 5, 7, 6};
constexpr std::uint8_t vtk_hexahedron = 12;
constexpr const char* vtk_units = "m, s, rad, Pa";

/// Components in VTK's order: xx, yy, zz, xy, yz, xz.
inline SymmetricTensor in_vtk_order(const SymmetricTensor& tensor) {
  return {tensor[0], tensor[1], tensor[2], tensor[5], tensor[3], tensor[4]};
}

/// Rotation vector [rad] of the stored quaternion, with an angle in [0, pi].
inline Vec3 rotation_vector_of(const double* fields) {
  const double sign = 1 + fields[qs] < 0 ? -1 : 1;
  const Vec3 r = {sign * fields[qx], sign * fields[qy], sign * fields[qz]};
  const double sine = std::hypot(r[0], r[1], r[2]), cosine = sign * (1 + fields[qs]);
  const double scale = sine > 0 ? 2 * std::atan2(sine, cosine) / sine : 2;
  return {scale * r[0], scale * r[1], scale * r[2]};
}

/// The body of each element.
inline std::vector<std::int32_t> body_numbers(const Lattice& lattice) {
  std::vector<std::int32_t> body(lattice.element_count);
  lattice.for_each_element([&](std::size_t e, const Row& row, int) { body[e] = row.body; });
  return body;
}

/// Calls put(name, count, value_of) for each array of nodes; value_of(n) is an array of numbers.
template <class Put>
void each_point_array(const StressOutput& stress, const NodeMotion& motion, Put&& put) {
  const std::size_t count = stress.at_nodes.size();
  put("displacement", count, [&](std::size_t node) { return motion.displacement[node]; });
  put("stress", count, [&](std::size_t node) { return in_vtk_order(stress.at_nodes[node]); });
  put("von_mises", count,
      [&](std::size_t node) { return std::array{von_mises(stress.at_nodes[node])}; });
}

/// The same for each array of elements.
template <class Put>
void each_cell_array(std::span<const double> state, std::span<const ElementStress> stress,
                     Put&& put) {
  const auto at = [&](int first) {
    return [&state, first](std::size_t cell) {
      const double* f = &state[cell * field_count + std::size_t(first)];
      return Vec3{f[0], f[1], f[2]};
    };
  };
  const std::size_t count = stress.size();
  put("displacement", count, at(ux));
  put("velocity", count, at(vx));
  put("rotation_vector", count,
      [&](std::size_t cell) { return rotation_vector_of(&state[cell * field_count]); });
  put("stress", count, [&](std::size_t cell) { return in_vtk_order(stress[cell].stress); });
  put("von_mises", count,
      [&](std::size_t cell) { return std::array{von_mises(stress[cell].stress)}; });
  put("principal_stress", count,
      [&](std::size_t cell) { return principal_values(stress[cell].stress); });
  put("strain", count, [&](std::size_t cell) { return in_vtk_order(stress[cell].strain); });
}

} // namespace dss
