#pragma once
/// State of one element, as every interface of the program passes it: 13 doubles in the global
/// frame, u [m], v [m/s], q, w [rad/s]. The rest state is all zeros: displacements instead of
/// positions, s = q0 - 1 instead of q0 (DESIGN.md section 3).
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace dss {

using Vec3 = std::array<double, 3>;

/// Index of each field. The fields of an element are contiguous. Elements follow each other in
/// global grid order, x fastest.
enum Field : int { ux, uy, uz, vx, vy, vz, qs, qx, qy, qz, wx, wy, wz, field_count };
inline constexpr std::array<std::string_view, field_count> field_names{
    "ux", "uy", "uz", "vx", "vy", "vz", "qs", "qx", "qy", "qz", "wx", "wy", "wz"};

/// Degrees of freedom as bits of a clamp: displacement along, rotation about a global axis.
enum Dof : std::uint8_t {
  dof_ux = 1,
  dof_uy = 2,
  dof_uz = 4,
  dof_rx = 8,
  dof_ry = 16,
  dof_rz = 32,
  dof_all = 63
};
inline constexpr std::array<std::string_view, 6> dof_names{"ux", "uy", "uz", "rx", "ry", "rz"};

} // namespace dss
