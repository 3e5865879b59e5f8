#pragma once
/// Arrays of NumPy (.npy files).
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace dss {

/// Cells of a grid: 1 where the array is not 0.
struct NpyMask {
  std::array<long, 3> shape{};     ///< along x, y, z: the array's first, second and third index
  std::vector<std::uint8_t> cells; ///< x fastest, then y, then z
};

/// Reads an array of three dimensions, of truth values, integers or floating-point numbers. All
/// numbers but 0 must be the same: a body has one material.
/// @param most_cells  that a grid may have
/// @throws InputError with the file: one that cannot be read, is none of NumPy, is cut off, or
///     whose array is of another type or shape
NpyMask read_npy_mask(const std::string& path, long most_cells);

} // namespace dss
