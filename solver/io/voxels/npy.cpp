#include "solver/io/voxels/npy.hpp"

#include "solver/error.hpp"
#include "solver/io/input_file.hpp"
#include "solver/io/voxels/voxel_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <string_view>
#include <vector>

namespace dss {
namespace {

constexpr std::string_view magic = "\x93NUMPY";

/// The header of a file: a Python dictionary (NEP 1 of NumPy).
struct Header {
  std::string type;
  bool is_x_fastest = false;
  std::array<long, 3> shape{};
  std::size_t data_at = 0;
};

/// The text behind 'key': in a dictionary.
std::string_view value_of(const std::string& path, std::string_view text, const char* key) {
  const std::string quoted = fmt::format("'{}':", key);
  const std::size_t at = text.find(quoted);
  if (at == std::string_view::npos)
    refuse_array(path, fmt::format("its header has no \"{}\"", key));
  text.remove_prefix(at + quoted.size());
  return text.substr(std::min(text.find_first_not_of(' '), text.size()));
}

std::array<long, 3> shape_of(const std::string& path, std::string_view text) {
  const std::string_view whole = text.substr(0, text.find(')') + 1);
  std::vector<long> sizes;
  for (text = whole; !text.empty();) {
    long size = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
    if (error == std::errc{}) sizes.push_back(size);
    text.remove_prefix(std::max<std::size_t>(1, std::size_t(end - text.data())));
  }
  if (sizes.size() != 3)
    refuse_array(path,
                 fmt::format("its shape is {}; a body has three dimensions, [x, y, z]", whole));
  return {sizes[0], sizes[1], sizes[2]};
}

Header header_of(const std::string& path, const std::string& bytes) {
  if (!bytes.starts_with(magic) || bytes.size() < 12) refuse_array(path, "is no array of NumPy");
  const char version = bytes[6];
  const std::size_t width = version == 1 ? 2 : 4;
  std::size_t length = 0;
  std::memcpy(&length, &bytes[8], width);
  Header header;
  header.data_at = 8 + width + length;
  if (header.data_at > bytes.size()) refuse_array(path, "is cut off in its header");
  const std::string_view text(&bytes[8 + width], length);
  const std::string_view type = value_of(path, text, "descr");
  if (!type.starts_with('\'')) refuse_array(path, "has records; give an array of numbers");
  header.type = type.substr(1, type.find('\'', 1) - 1);
  header.is_x_fastest = value_of(path, text, "fortran_order").starts_with("True");
  header.shape = shape_of(path, value_of(path, text, "shape"));
  return header;
}

const NumberType& type_of(const std::string& path, const std::string& name) {
  for (const NumberType& type : number_types())
    if (name == fmt::format("{}{}", type.size == 1 ? '|' : '<', type.name)) return type;
  refuse_array(path,
               fmt::format("its numbers are of the type \"{}\"; give truth values, integers or "
                           "floating-point numbers, little-endian (\"|b1\", \"|u1\", \"<f8\")",
                           name));
}

} // namespace

VoxelGrid read_npy_voxels(const std::string& path, long most_cells) {
  const std::string bytes = bytes_of("array file", path);
  const Header header = header_of(path, bytes);
  return voxels_of({path, header.shape, header.is_x_fastest, &type_of(path, header.type),
                    std::string_view(bytes).substr(header.data_at)},
                   most_cells);
}

void write_npy_voxels(AtomicFile& file, const VoxelGrid& grid) {
  std::string header =
      fmt::format("{{'descr': '|u1', 'fortran_order': True, 'shape': ({}, {}, {}), }}", grid.nx,
                  grid.ny, grid.nz);
  constexpr std::size_t before = 10, alignment = 64; // the whole header is a multiple of 64 bytes
  header.append(alignment - 1 - (before + header.size()) % alignment, ' ');
  header += '\n';
  file.write(magic);
  file.write(std::string{'\x01', '\0', char(header.size() & 0xffU), char(header.size() >> 8U)});
  file.write(header);
  file.write({reinterpret_cast<const char*>(grid.occupied.data()), grid.occupied.size()});
}

} // namespace dss
