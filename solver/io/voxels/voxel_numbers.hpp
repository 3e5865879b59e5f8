#pragma once
/// Numbers of a file that become voxels: 0 is a hole, 1 to 255 an element of that material.
#include "solver/lattice/lattice.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace dss {

/// A type of numbers in files, little-endian.
struct NumberType {
  std::string_view name; ///< NumPy's: "u1", "i2", "f8"
  std::string_view vtk;  ///< VTK's: "UInt8", "Int16", "Float64"
  std::size_t size;      ///< [bytes]
  double (*read)(const char* at);
};
std::span<const NumberType> number_types();
/// Names of all, for errors.
std::string number_type_names();

/// An array in a file.
struct VoxelArray {
  std::string path;            ///< for errors
  std::array<long, 3> shape{}; ///< along x, y, z
  bool is_x_fastest = true;    ///< else z is
  const NumberType* type = nullptr;
  std::string_view bytes;
};

/// @param most_cells  that a grid may have
/// @throws InputError for an empty shape, too many cells, another number of bytes than the shape
///     needs, or a number that is not 0 to 255 and whole
VoxelGrid voxels_of(const VoxelArray& array, long most_cells);

/// @throws InputError "array file PATH: WHAT"
[[noreturn]] void refuse_array(const std::string& path, const std::string& what);

/// Reads a file that holds nothing but the numbers of an array, x fastest.
/// @throws InputError as above
VoxelGrid read_raw_voxels(const std::string& path, const std::array<long, 3>& shape,
                          const NumberType& type, long most_cells);

} // namespace dss
