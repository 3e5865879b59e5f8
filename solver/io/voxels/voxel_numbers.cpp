#include "solver/io/voxels/voxel_numbers.hpp"

#include "solver/error.hpp"
#include "solver/io/input_file.hpp"
#include "solver/memory.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>

namespace dss {
namespace {

static_assert(std::endian::native == std::endian::little,
              "arrays are read as they lie in the file");

template <class T>
double read_as(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return double(value);
}

constexpr NumberType number_type_list[] = {
    {"b1", "Bit", 1, read_as<std::uint8_t>},   {"u1", "UInt8", 1, read_as<std::uint8_t>},
    {"i1", "Int8", 1, read_as<std::int8_t>},   {"u2", "UInt16", 2, read_as<std::uint16_t>},
    {"i2", "Int16", 2, read_as<std::int16_t>}, {"u4", "UInt32", 4, read_as<std::uint32_t>},
    {"i4", "Int32", 4, read_as<std::int32_t>}, {"u8", "UInt64", 8, read_as<std::uint64_t>},
    {"i8", "Int64", 8, read_as<std::int64_t>}, {"f4", "Float32", 4, read_as<float>},
    {"f8", "Float64", 8, read_as<double>}};

constexpr double most_material = 255;

void require_sound(const VoxelArray& array, long most_cells) {
  const auto [nx, ny, nz] = array.shape;
  const double cells = double(nx) * double(ny) * double(nz);
  if (nx < 1 || ny < 1 || nz < 1)
    refuse_array(array.path, "it is empty; a body has at least one element");
  if (cells > double(most_cells))
    refuse_array(array.path,
                 fmt::format("it has {:.0f} cells, too many; at most {}", cells, most_cells));
  if (double(array.bytes.size()) != cells * double(array.type->size))
    refuse_array(array.path,
                 fmt::format("it has {} bytes of numbers; its shape [{}, {}, {}] needs {:.0f}",
                             array.bytes.size(), nx, ny, nz, cells * double(array.type->size)));
}

} // namespace

void refuse_array(const std::string& path, const std::string& what) {
  throw InputError(fmt::format("array file {}: {}", path, what));
}

std::span<const NumberType> number_types() { return number_type_list; }

std::string number_type_names() {
  std::string names;
  for (const NumberType& type : number_type_list)
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", type.name);
  return names;
}

VoxelGrid voxels_of(const VoxelArray& array, long most_cells) {
  require_sound(array, most_cells);
  const auto [nx, ny, nz] = array.shape;
  const auto cells = std::size_t(nx * ny * nz);
  // The grid and the lattice that is made from it take a byte each.
  require_memory(2 * double(cells), fmt::format("array file {}", array.path), "give a smaller one");
  VoxelGrid grid{int(nx), int(ny), int(nz), std::vector<std::uint8_t>(cells)};
  std::size_t cell = 0;
  for (long z = 0; z < nz; ++z)
    for (long y = 0; y < ny; ++y)
      for (long x = 0; x < nx; ++x, ++cell) {
        const long at = array.is_x_fastest ? (z * ny + y) * nx + x : (x * ny + y) * nz + z;
        const double value = array.type->read(&array.bytes[std::size_t(at) * array.type->size]);
        if (!(value >= 0 && value <= most_material) || value != double(int(value)))
          refuse_array(
              array.path,
              fmt::format("it has {:g} at [{}, {}, {}]; a cell is 0 (a hole) or the whole number "
                          "of its material, up to {}",
                          value, x, y, z, most_material));
        grid.occupied[cell] = std::uint8_t(value);
      }
  return grid;
}

VoxelGrid read_raw_voxels(const std::string& path, const std::array<long, 3>& shape,
                          const NumberType& type, long most_cells) {
  const std::string bytes = bytes_of("array file", path);
  return voxels_of({path, shape, true, &type, bytes}, most_cells);
}

} // namespace dss
