#pragma once
/// Arrays of NumPy (.npy files).
#include "solver/io/atomic_file.hpp"
#include "solver/lattice/lattice.hpp"

#include <string>

namespace dss {

/// Reads an array of three dimensions [x, y, z], of truth values, integers or floating-point
/// numbers: 0 is a hole, 1 to 255 an element of that material.
/// @param most_cells  that a grid may have
/// @throws InputError with the file: one that cannot be read, is none of NumPy, is cut off, or
///     whose array is of another type or shape
VoxelGrid read_npy_voxels(const std::string& path, long most_cells);

/// Writes such an array, of the type uint8. @param file  its caller commits it
void write_npy_voxels(AtomicFile& file, const VoxelGrid& grid);

} // namespace dss
