#pragma once
/// Where lines through the cells of a grid cross a surface.
#include "solver/surface/surface.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace dss {

/// A regular grid of box cells in space.
struct SpaceGrid {
  Eigen::Vector3d low{0, 0, 0};  ///< low corner of cell (0, 0, 0) [m]
  Eigen::Vector3d edge{1, 1, 1}; ///< edges of a cell [m]
  std::array<int, 3> count{};    ///< cells along x, y, z
  double centre(int axis, int cell) const { return low[axis] + (cell + 0.5) * edge[axis]; }
  std::size_t cells() const {
    return std::size_t(count[0]) * std::size_t(count[1]) * std::size_t(count[2]);
  }
};

/// A line along an axis crosses a triangle.
struct Crossing {
  double at = 0;          ///< place along the axis [m]
  Eigen::Vector3d normal; ///< outer one of the triangle, length 1
  std::uint32_t triangle = 0;
};

/// A part of a line inside of a surface.
struct Span {
  Crossing in, out;
  int most_enclosed = 1; ///< largest absolute winding number; more than 1 where parts overlap
};
/// Where a line is inside: where its winding number is not 0. Parts that overlap are one span.
/// @param line  its crossings, ascending, along `axis`
std::vector<Span> spans(const std::vector<Crossing>& line, int axis);

/// The crossings of the lines along one axis through the centres of cells.
class Crossings {
public:
  /// @param axis  of the lines
  Crossings(const Surface& surface, const SpaceGrid& grid, int axis);
  /// The crossings of a line, by their places, ascending.
  /// @param u, v  its cells along the two other axes, in their order
  const std::vector<Crossing>& of_line(int u, int v) const {
    return lines_[std::size_t(v) * std::size_t(count_u_) + std::size_t(u)];
  }
  /// The other axes, ascending.
  static std::array<int, 2> across(int axis) { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }

private:
  int count_u_ = 0;
  std::vector<std::vector<Crossing>> lines_;
};

} // namespace dss
