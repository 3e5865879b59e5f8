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

} // namespace dss
