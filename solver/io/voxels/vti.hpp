#pragma once
/// Image data of VTK (.vti files) as voxels.
#include "kernels/fields.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/lattice/lattice.hpp"

#include <array>
#include <string>

namespace dss {

/// A grid with its place, in the unit of its file.
struct ImageVoxels {
  VoxelGrid grid;
  Vec3 spacing{}; ///< of cells
  Vec3 origin{};  ///< low corner of cell (0, 0, 0)
};

/// Reads an array of an image: 0 is a hole, 1 to 255 an element of that material. Data of cells and
/// of points serve: each point is the centre of a cell, then. Text, base64 and appended data, plain
/// or compressed by zlib.
/// @param array       its name; empty: the only one of the file
/// @param most_cells  that a grid may have
/// @throws InputError with the file: one that cannot be read, is no image in one piece, has turned
///     axes, is cut off, or whose array is absent or of another type
ImageVoxels read_vti_voxels(const std::string& path, const std::string& array, long most_cells);

/// Writes such an image with the array "material" on its cells. @param file  its caller commits it
void write_vti_voxels(AtomicFile& file, const ImageVoxels& image);

} // namespace dss
