#include "solver/surface/stl.hpp"

#include "solver/error.hpp"
#include "solver/io/input_file.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <string_view>
#include <unordered_map>

namespace dss {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie in a file");

[[noreturn]] void refuse_stl(const std::string& path, const std::string& what) {
  throw InputError(fmt::format("STL file {}: {}", path, what));
}

using Corner = std::array<float, 3>; // as in the file
struct CornerHash {
  std::size_t operator()(const Corner& c) const {
    std::size_t hash = 0;
    for (const float x : c) hash = (hash ^ std::bit_cast<std::uint32_t>(x)) * 0x9e3779b97f4a7c15U;
    return hash ^ hash >> 32U;
  }
};

/// Gathers the triangles of a file.
class Builder {
public:
  Builder(const std::string& path, const SurfacePlacement& placement) : placement_(placement) {
    surface_.path = path;
  }
  void add(std::array<Corner, 3> triangle) {
    ++count_;
    std::array<std::uint32_t, 3> numbers{};
    for (std::size_t n = 0; n < 3; ++n) numbers[n] = number_of(triangle[n]);
    if (numbers[0] == numbers[1] || numbers[1] == numbers[2] || numbers[2] == numbers[0]) return;
    if (placement_.is_mirrored()) std::swap(numbers[1], numbers[2]);
    surface_.triangles.push_back(numbers);
  }
  Surface finished() {
    if (surface_.triangles.empty()) refuse_stl(surface_.path, "it has no triangle");
    return std::move(surface_);
  }

private:
  std::uint32_t number_of(Corner& corner) {
    for (float& x : corner) {
      if (!std::isfinite(x))
        refuse_stl(surface_.path, fmt::format("triangle {} has a number that is not finite",
                                              surface_.triangles.size()));
      x += 0.0F; // -0 becomes 0
    }
    const auto [place, is_new] =
        numbers_.try_emplace(corner, std::uint32_t(surface_.corners.size()));
    if (is_new) {
      Eigen::Vector3d own;
      for (std::size_t a = 0; a < 3; ++a) {
        const double x = placement_.unit * double(corner[std::size_t(placement_.axis[a])]);
        own[Eigen::Index(a)] = placement_.is_reversed[a] ? -x : x;
      }
      surface_.corners.push_back(own);
    }
    return place->second;
  }

  SurfacePlacement placement_;
  Surface surface_;
  std::size_t count_ = 0; ///< of triangles so far, with those that are left out
  std::unordered_map<Corner, std::uint32_t, CornerHash> numbers_;
};

// Binary: a header of 80 bytes, the number of triangles, then a normal, three corners and two bytes
// for each.
constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

std::size_t binary_count(const std::string& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= header_bytes) std::memcpy(&count, &bytes[80], sizeof count);
  return count;
}

bool is_binary(const std::string& bytes) {
  return bytes.size() >= header_bytes &&
         bytes.size() == header_bytes + triangle_bytes * binary_count(bytes);
}

void read_binary(const std::string& bytes, Builder& builder) {
  for (std::size_t at = header_bytes; at < bytes.size(); at += triangle_bytes) {
    std::array<Corner, 3> triangle;
    std::memcpy(&triangle, &bytes[at + sizeof(Corner)], sizeof triangle);
    builder.add(triangle);
  }
}

/// The words of an ASCII file.
class Words {
public:
  explicit Words(std::string_view text) : text_(text) {}
  std::string_view next() {
    const std::size_t begin = std::min(text_.find_first_not_of(" \t\r\n"), text_.size());
    text_.remove_prefix(begin);
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n"), text_.size());
    const std::string_view word = text_.substr(0, end);
    text_.remove_prefix(end);
    return word;
  }

private:
  std::string_view text_;
};

void read_ascii(const std::string& path, const std::string& bytes, Builder& builder) {
  Words words(bytes);
  std::array<Corner, 3> triangle{};
  std::size_t corners = 0, triangles = 0;
  bool is_in_solid = false, is_in_facet = false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "solid") is_in_solid = true;
    if (word == "endsolid") is_in_solid = false;
    if (word == "facet") corners = 0, is_in_facet = true;
    if (word == "vertex") {
      if (corners == 3)
        refuse_stl(path, fmt::format("facet {} has more than three vertices", triangles));
      for (float& x : triangle[corners]) {
        std::string_view number = words.next();
        if (number.starts_with('+')) number.remove_prefix(1);
        double value = 0; // in single precision, a tiny number would be out of range
        const auto [end, error] =
            std::from_chars(number.data(), number.data() + number.size(), value);
        if (number.empty() || error != std::errc{} || end != number.data() + number.size())
          refuse_stl(path, fmt::format("facet {}: \"{}\" is not a number", triangles, number));
        x = float(value);
      }
      ++corners;
    }
    if (word == "endfacet") {
      if (corners != 3)
        refuse_stl(path, fmt::format("facet {} has {} vertices", triangles, corners));
      builder.add(triangle);
      ++triangles;
      is_in_facet = false;
    }
  }
  if (is_in_solid || is_in_facet) refuse_stl(path, "it is cut off: its solid does not end");
}

} // namespace

Surface read_stl(const std::string& path, const SurfacePlacement& placement) {
  const std::string bytes = bytes_of("STL file", path);
  Builder builder(path, placement);
  if (is_binary(bytes)) {
    read_binary(bytes, builder);
  } else if (bytes.starts_with("solid") && bytes.find('\0') == std::string::npos) {
    read_ascii(path, bytes, builder);
  } else if (bytes.size() >= header_bytes) {
    refuse_stl(path,
               fmt::format("it has {} bytes; a binary file of {} triangles has {}, and an ASCII "
                           "file begins with \"solid\"",
                           bytes.size(), binary_count(bytes),
                           header_bytes + triangle_bytes * binary_count(bytes)));
  } else {
    refuse_stl(path, "it is neither a binary nor an ASCII STL file");
  }
  return builder.finished();
}

} // namespace dss
