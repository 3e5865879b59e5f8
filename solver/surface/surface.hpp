#pragma once
/// Closed surfaces of triangles, as CAD programs export them.
#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace dss {

/// Triangles over shared corners. The outer side is the one from which a triangle's corners run
/// counter-clockwise.
struct Surface {
  std::string path;                                    ///< of its file, for errors
  std::vector<Eigen::Vector3d> corners;                ///< [m]; no two are equal
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< numbers of three different corners

  std::array<Eigen::Vector3d, 3> corners_of(std::size_t triangle) const {
    const auto& [a, b, c] = triangles[triangle];
    return {corners[a], corners[b], corners[c]};
  }
  /// Half of the cross product of two edges: the area [m^2], along the outer normal.
  Eigen::Vector3d area_of(std::size_t triangle) const;
};

/// Low and high corner of the box around a surface [m].
std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds(const Surface& surface);

/// Enclosed volume [m^3], negative if the triangles show their inner sides. It has no meaning if
/// the surface is open.
double enclosed_volume(const Surface& surface);

/// Number of edges at which triangles do not join in pairs of opposite directions: 0 if the surface
/// is closed, and all triangles show the same side.
std::size_t unpaired_edges(const Surface& surface);

/// Of each triangle the neighbours across its edges (0 to 1, 1 to 2, 2 to 0); itself where there is
/// none.
std::vector<std::array<std::uint32_t, 3>> triangle_neighbours(const Surface& surface);

} // namespace dss
