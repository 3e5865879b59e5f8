#pragma once
/// How well voxels represent the body inside of a surface.
#include "solver/lattice/lattice.hpp"
#include "solver/surface/crossings.hpp"
#include "solver/surface/surface.hpp"

#include <optional>
#include <vector>

namespace dss {

/// A place where a body is thin: between two faces that are nearly parallel.
struct Wall {
  double thickness = 0;           ///< [m]
  double elements = 0;            ///< thickness in cells, along the normal
  Eigen::Vector3d place{0, 0, 0}; ///< its middle [m]
};

struct ShapeReport {
  std::size_t elements = 0;
  /// [m^3]. That of a surface of parts that overlap is measured along lines through the centres of
  /// cells, so it is right to first order in their size.
  /// That of an open surface is not known: NaN.
  double surface_volume = 0, voxel_volume = 0;
  std::optional<Wall> thinnest;    ///< none if no two faces are nearly parallel
  std::vector<std::size_t> pieces; ///< elements of each connected piece, the largest first
  double volume_error() const { return voxel_volume / surface_volume - 1; }
};

ShapeReport report_shape(const Surface& surface, const SpaceGrid& grid, const VoxelGrid& voxels);

/// Sizes of the pieces that links do not connect, the largest first.
std::vector<std::size_t> pieces_of(const VoxelGrid& voxels);

} // namespace dss
