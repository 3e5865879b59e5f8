#pragma once
/// The shapes of the bodies of a scene.
#include "solver/json/object_node.hpp"
#include "solver/lattice/lattice.hpp"

namespace dss {

/// Most elements of a scene, over all bodies.
constexpr long max_elements = (1L << 31) - 1;

/// Reads {"box": [nx, ny, nz]}, {"boxes": [{"from", "size"}, ...]} (their union) or {"voxels":
/// {"layers" | "file"}}.
/// @throws InputError for an empty shape, or for a grid of more than max_elements cells
VoxelGrid read_geometry(const Node& node);

/// Bounds of the size of a shape, or of all shapes of a scene.
struct ShapeSize {
  double cells = 0;          ///< of its grid: elements are at most that
  double least_elements = 0; ///< 0 where only its cells tell
};

/// Finds the size of a shape without building it. @throws InputError as read_geometry
ShapeSize shape_size(const Node& node);

} // namespace dss
