#pragma once
/// The state of one element as it crosses every interface of the program: 13 doubles in the global frame.
/// The rest state is all zeros (DESIGN.md section 3): displacements instead of positions, s = q0 - 1 instead of q0.
#include <array>
#include <cstddef>
#include <cstdint>

namespace dss {

using Vec3 = std::array<double, 3>;

/// Index of each field; an element's fields are contiguous, elements follow in global grid order (x fastest).
enum Field : int { ux, uy, uz, vx, vy, vz, qs, qx, qy, qz, wx, wy, wz, field_count };

/// Degrees of freedom as bits of a clamp: translation along, rotation about the global axes.
enum Dof : std::uint8_t { dof_ux = 1, dof_uy = 2, dof_uz = 4, dof_rx = 8, dof_ry = 16, dof_rz = 32, dof_all = 63 };

} // namespace dss
