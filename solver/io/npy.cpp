#include "solver/io/npy.hpp"

#include "solver/error.hpp"
#include "solver/io/input_file.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>
#include <utility>

namespace dss {
namespace {

static_assert(std::endian::native == std::endian::little,
              "arrays are read as they lie in the file");

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw InputError(fmt::format("array file {}: {}", path, what));
}

std::string bytes_of(const std::string& path) {
  std::ifstream file =
      open_whole(path, 2, fmt::format("the array of {}", path), "give a smaller one");
  if (!file.is_open()) refuse(path, "cannot be read");
  std::string bytes(std::filesystem::file_size(path), '\0');
  if (!file.read(bytes.data(), std::streamsize(bytes.size()))) refuse(path, "cannot be read");
  return bytes;
}

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
  if (at == std::string_view::npos) refuse(path, fmt::format("its header has no \"{}\"", key));
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
    refuse(path, fmt::format("its shape is {}; a body has three dimensions, [x, y, z]", whole));
  return {sizes[0], sizes[1], sizes[2]};
}

Header header_of(const std::string& path, const std::string& bytes) {
  constexpr std::string_view magic = "\x93NUMPY";
  if (!bytes.starts_with(magic) || bytes.size() < 12) refuse(path, "is no array of NumPy");
  const char version = bytes[6];
  const std::size_t width = version == 1 ? 2 : 4;
  std::size_t length = 0;
  std::memcpy(&length, &bytes[8], width);
  Header header;
  header.data_at = 8 + width + length;
  if (header.data_at > bytes.size()) refuse(path, "is cut off in its header");
  const std::string_view text(&bytes[8 + width], length);
  const std::string_view type = value_of(path, text, "descr");
  if (!type.starts_with('\'')) refuse(path, "has records; give an array of numbers");
  header.type = type.substr(1, type.find('\'', 1) - 1);
  header.is_x_fastest = value_of(path, text, "fortran_order").starts_with("True");
  header.shape = shape_of(path, value_of(path, text, "shape"));
  return header;
}

/// Reads a number at a place of the file.
using Reader = double (*)(const char* at);
template <class T>
double read_as(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return double(value);
}

struct NumberType {
  std::string_view name;
  std::size_t size;
  Reader read;
};
constexpr NumberType types[] = {
    {"|b1", 1, read_as<std::uint8_t>}, {"|u1", 1, read_as<std::uint8_t>},
    {"|i1", 1, read_as<std::int8_t>},  {"<u2", 2, read_as<std::uint16_t>},
    {"<i2", 2, read_as<std::int16_t>}, {"<u4", 4, read_as<std::uint32_t>},
    {"<i4", 4, read_as<std::int32_t>}, {"<u8", 8, read_as<std::uint64_t>},
    {"<i8", 8, read_as<std::int64_t>}, {"<f4", 4, read_as<float>},
    {"<f8", 8, read_as<double>}};

const NumberType& type_of(const std::string& path, const std::string& name) {
  for (const NumberType& type : types)
    if (type.name == name) return type;
  refuse(path, fmt::format("its numbers are of the type \"{}\"; give truth values, integers or "
                           "floating-point numbers, little-endian (\"|b1\", \"|u1\", \"<f8\")",
                           name));
}

} // namespace

NpyMask read_npy_mask(const std::string& path, long most_cells) {
  const std::string bytes = bytes_of(path);
  const Header header = header_of(path, bytes);
  const NumberType& type = type_of(path, header.type);
  const auto [nx, ny, nz] = header.shape;
  const double cells = double(nx) * double(ny) * double(nz);
  if (nx < 1 || ny < 1 || nz < 1) refuse(path, "it is empty; a body has at least one element");
  if (cells > double(most_cells))
    refuse(path, fmt::format("it has {:.0f} cells, too many; at most {}", cells, most_cells));
  if (double(bytes.size() - header.data_at) != cells * double(type.size))
    refuse(path, fmt::format("it has {} bytes of numbers; its shape [{}, {}, {}] needs {:.0f}",
                             bytes.size() - header.data_at, nx, ny, nz, cells * double(type.size)));
  NpyMask mask{header.shape, std::vector<std::uint8_t>(std::size_t(cells))};
  double material = 0;
  std::size_t cell = 0;
  for (long z = 0; z < nz; ++z)
    for (long y = 0; y < ny; ++y)
      for (long x = 0; x < nx; ++x, ++cell) {
        const long at = header.is_x_fastest ? (z * ny + y) * nx + x : (x * ny + y) * nz + z;
        const double value = type.read(&bytes[header.data_at + std::size_t(at) * type.size]);
        if (value == 0) continue;
        if (material == 0) material = value;
        if (value != material) // and if it is not a number
          refuse(path, fmt::format("it has {:g} and {:g} besides 0; a body has one material, so "
                                   "give one other number",
                                   material, value));
        mask.cells[cell] = 1;
      }
  return mask;
}

} // namespace dss
