#pragma once
/// Voxels that a scene lists, or has in a file.
#include "solver/json/object_node.hpp"
#include "solver/lattice/lattice.hpp"

#include <optional>

namespace dss {

/// Cells, and their size and place if the file gives them.
struct VoxelFile {
  VoxelGrid grid;
  std::optional<Vec3> edge;   ///< of a cell [m]
  std::optional<Vec3> origin; ///< low corner of cell (0, 0, 0) [m]
};

/// Reads {"layers": ...} or {"file": ...}: a text, an array of NumPy (.npy), image data of VTK
/// (.vti) or plain numbers (.raw). @throws InputError
VoxelFile read_voxels(const Node& node);

} // namespace dss
