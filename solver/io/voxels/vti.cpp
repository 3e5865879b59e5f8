#include "solver/io/voxels/vti.hpp"

#include "solver/error.hpp"
#include "solver/io/input_file.hpp"
#include "solver/io/voxels/voxel_numbers.hpp"
#include "solver/memory.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>
#include <vector>
#include <zlib.h>

namespace dss {
namespace {

[[noreturn]] void refuse_image(const std::string& path, const std::string& what) {
  throw InputError(fmt::format("image file {}: {}", path, what));
}

std::string base64_decoded(const std::string& path, std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t group = 0;
  int held = 0;
  for (const char c : text) {
    int digit = 0;
    if (c >= 'A' && c <= 'Z')
      digit = c - 'A';
    else if (c >= 'a' && c <= 'z')
      digit = c - 'a' + 26;
    else if (c >= '0' && c <= '9')
      digit = c - '0' + 52;
    else if (c == '+')
      digit = 62;
    else if (c == '/')
      digit = 63;
    else if (c == '=')
      break;
    else
      refuse_image(path, "its base64 text has other characters");
    group = group << 6U | std::uint32_t(digit);
    if (++held < 4) continue;
    for (const unsigned shift : {16U, 8U, 0U}) bytes += char(group >> shift & 0xffU);
    group = 0, held = 0;
  }
  if (held > 1) bytes += char(group >> (6U * unsigned(held) - 8) & 0xffU);
  if (held > 2) bytes += char(group >> (6U * unsigned(held) - 16) & 0xffU);
  return bytes;
}

/// Three numbers of an attribute.
template <class T>
std::vector<T> numbers_of(const pugi::xml_node& node, const char* attribute) {
  std::istringstream text(node.attribute(attribute).value());
  std::vector<T> numbers;
  for (T number; text >> number;) numbers.push_back(number);
  return numbers;
}

/// An .vti file. Appended data follow the XML, so that the whole is no XML.
class Image {
public:
  explicit Image(const std::string& path) : path_(path), bytes_(bytes_of("image file", path)) {
    const std::size_t appended = bytes_.find("<AppendedData");
    std::string head = bytes_.substr(0, appended);
    if (appended != std::string::npos) {
      const std::size_t begin = bytes_.find('_', bytes_.find('>', appended));
      if (begin == std::string::npos) refuse_image(path_, "it is cut off in its appended data");
      is_raw_ = bytes_.substr(appended, begin - appended).find("\"raw\"") != std::string::npos;
      tail_ = std::string_view(bytes_).substr(begin + 1);
      head += "</VTKFile>";
    }
    const pugi::xml_parse_result result = document_.load_string(head.c_str());
    if (!result)
      refuse_image(path_, fmt::format("it is no XML of VTK: {} at byte {}", result.description(),
                                      long(result.offset)));
    file_ = document_.child("VTKFile");
    image_ = file_.child("ImageData");
    if (!image_) refuse_image(path_, "it holds no ImageData");
    if (std::string_view(file_.attribute("byte_order").value()) == "BigEndian")
      refuse_image(path_, "its numbers are big-endian; write them little-endian");
    const auto pieces = image_.children("Piece");
    if (std::distance(pieces.begin(), pieces.end()) != 1)
      refuse_image(path_, "its image is not in one piece; write it in one");
  }
  ImageVoxels voxels(const std::string& name, long most_cells);

private:
  /// Cells, or points, along x, y, z.
  std::array<long, 3> shape(bool is_of_cells) const {
    const std::vector<long> extent = numbers_of<long>(image_.child("Piece"), "Extent");
    if (extent.size() != 6) refuse_image(path_, "its piece has no Extent of six numbers");
    std::array<long, 3> shape{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double size = double(extent[2 * a + 1]) - double(extent[2 * a]);
      if (!(size >= 0 && size < 0x1p31)) refuse_image(path_, "the Extent of its piece is wrong");
      shape[a] = long(size) + (is_of_cells ? 0 : 1);
    }
    return shape;
  }
  std::pair<pugi::xml_node, bool> find(const std::string& name) const;
  std::string data_of(const pugi::xml_node& array, const NumberType& type, double most) const;
  std::string decoded(std::string_view text, bool is_raw, double most) const;
  std::string inflated(std::string_view text, bool is_raw, double most) const;
  std::size_t word_bytes() const {
    return std::string_view(file_.attribute("header_type").value()) == "UInt64" ? 8 : 4;
  }
  std::size_t word(std::string_view bytes, std::size_t n) const {
    if (bytes.size() < (n + 1) * word_bytes()) refuse_image(path_, "it is cut off");
    std::size_t value = 0;
    std::memcpy(&value, &bytes[n * word_bytes()], word_bytes());
    return value;
  }

  std::string path_, bytes_;
  std::string_view tail_; ///< appended data
  bool is_raw_ = false;   ///< else base64
  pugi::xml_document document_;
  pugi::xml_node file_, image_;
};

/// The array, and whether it is one of cells.
std::pair<pugi::xml_node, bool> Image::find(const std::string& name) const {
  std::vector<std::pair<pugi::xml_node, bool>> found;
  std::vector<std::string> names;
  for (const char* of : {"CellData", "PointData"})
    for (const pugi::xml_node& array : image_.child("Piece").child(of).children("DataArray")) {
      names.emplace_back(array.attribute("Name").value());
      if (name.empty() || names.back() == name)
        found.emplace_back(array, of == std::string_view("CellData"));
    }
  if (found.size() != 1)
    refuse_image(path_,
                 fmt::format("its arrays are: {}; name one by \"array\"", fmt::join(names, ", ")));
  const std::string_view components = found[0].first.attribute("NumberOfComponents").value();
  if (!components.empty() && components != "1")
    refuse_image(path_, fmt::format("array {} has {} components; a material has one",
                                    found[0].first.attribute("Name").value(), components));
  return found[0];
}

/// Blocks of zlib behind a header of their sizes (VTK's XML format).
std::string Image::inflated(std::string_view text, bool is_raw, double most) const {
  const auto digits = [](std::size_t bytes) { return (bytes + 2) / 3 * 4; };
  const auto head = [&](std::size_t words) {
    const std::size_t size = words * word_bytes();
    return is_raw ? std::string(text.substr(0, size))
                  : base64_decoded(path_, text.substr(0, digits(size)));
  };
  const std::size_t blocks = word(head(1), 0);
  if (double(blocks) > double(text.size())) refuse_image(path_, "it is cut off");
  const std::size_t words = 3 + blocks;
  const std::string header = head(words);
  const std::size_t behind = is_raw ? words * word_bytes() : digits(words * word_bytes());
  if (behind > text.size()) refuse_image(path_, "it is cut off");
  std::string packed;
  if (!is_raw) packed = base64_decoded(path_, text.substr(behind));
  std::string_view rest = is_raw ? text.substr(behind) : std::string_view(packed);
  std::string whole;
  for (std::size_t n = 0; n < blocks; ++n) {
    const std::size_t last = word(header, 2);
    uLongf size = n + 1 == blocks && last > 0 ? last : word(header, 1);
    const std::size_t taken = word(header, 3 + n);
    if (taken > rest.size() || double(whole.size()) + double(size) > most)
      refuse_image(path_, "its compressed blocks do not have the size of the array");
    std::string block(size, '\0');
    if (uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
                   reinterpret_cast<const Bytef*>(rest.data()), taken) != Z_OK ||
        size != block.size())
      refuse_image(path_, "a compressed block is damaged");
    whole += block;
    rest.remove_prefix(taken);
  }
  return whole;
}

std::string Image::decoded(std::string_view text, bool is_raw, double most) const {
  const std::string_view compressor = file_.attribute("compressor").value();
  if (compressor == "vtkZLibDataCompressor") return inflated(text, is_raw, most);
  if (!compressor.empty())
    refuse_image(path_,
                 fmt::format("it is compressed by {}; use vtkZLibDataCompressor", compressor));
  std::string own;
  if (!is_raw) own = base64_decoded(path_, text);
  const std::string_view bytes = is_raw ? text : std::string_view(own);
  const std::size_t size = word(bytes, 0);
  if (size > bytes.size() - word_bytes()) refuse_image(path_, "it is cut off");
  return std::string(bytes.substr(word_bytes(), size));
}

std::string without_space(std::string_view text) {
  std::string out(text);
  std::erase_if(out, [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; });
  return out;
}

/// @param most  bytes that its shape needs
std::string Image::data_of(const pugi::xml_node& array, const NumberType& type, double most) const {
  const std::string_view format = array.attribute("format").value();
  if (format == "appended") {
    const std::size_t offset = array.attribute("offset").as_ullong();
    if (offset >= tail_.size()) refuse_image(path_, "its appended data are cut off");
    std::string_view text = tail_.substr(offset);
    std::string own;
    if (!is_raw_) {
      own = without_space(text.substr(0, text.find('<')));
      text = own;
    }
    return decoded(text, is_raw_, most);
  }
  if (format == "binary") return decoded(without_space(array.child_value()), false, most);
  // Text: as the bytes of the type, so that one function reads all.
  if (type.size != 1)
    refuse_image(path_, "its array is text of a wide type; write UInt8, or binary data");
  std::istringstream text(array.child_value());
  std::string bytes;
  for (int number; double(bytes.size()) <= most && text >> number;) {
    if (number < 0 || number > 255)
      refuse_image(path_, fmt::format("it has {}; a material is at most 255", number));
    bytes += char(number);
  }
  return bytes;
}

ImageVoxels Image::voxels(const std::string& name, long most_cells) {
  const auto [array, is_of_cells] = find(name);
  const std::string_view type_name = array.attribute("type").value();
  const auto known = number_types();
  const auto type = std::ranges::find(known, type_name, &NumberType::vtk);
  if (type == known.end() || type->name == "b1")
    refuse_image(path_, fmt::format("its array is of the type \"{}\"; write UInt8", type_name));
  const std::vector<double> spacing = numbers_of<double>(image_, "Spacing"),
                            origin = numbers_of<double>(image_, "Origin"),
                            direction = numbers_of<double>(image_, "Direction");
  const std::vector<double> straight = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (!direction.empty() && direction != straight)
    refuse_image(path_, "its axes are turned (Direction); write it along x, y and z");
  if (spacing.size() != 3 || origin.size() != 3 || std::ranges::min(spacing) <= 0)
    refuse_image(path_, "it has no Origin and Spacing of three numbers");
  const std::array<long, 3> cells = shape(is_of_cells);
  const double most = double(type->size) * double(cells[0]) * double(cells[1]) * double(cells[2]);
  if (most > double(type->size) * double(most_cells))
    refuse_image(path_, fmt::format("it has more than {} cells, too many", most_cells));
  require_memory(2 * most, fmt::format("image file {}", path_), "give a smaller one");
  const std::string bytes = data_of(array, *type, most);
  ImageVoxels image;
  image.grid = voxels_of({path_, cells, true, &*type, bytes}, most_cells);
  const std::vector<long> extent = numbers_of<long>(image_.child("Piece"), "Extent");
  for (std::size_t a = 0; a < 3; ++a) {
    image.spacing[a] = spacing[a];
    image.origin[a] = origin[a] + (double(extent[2 * a]) - (is_of_cells ? 0.0 : 0.5)) * spacing[a];
  }
  return image;
}

} // namespace

ImageVoxels read_vti_voxels(const std::string& path, const std::string& array, long most_cells) {
  return Image(path).voxels(array, most_cells);
}

void write_vti_voxels(AtomicFile& file, const ImageVoxels& image) {
  const VoxelGrid& grid = image.grid;
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", grid.nx, grid.ny, grid.nz);
  file.write(
      fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
                  "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
                  "<ImageData WholeExtent=\"{}\" Origin=\"{:.17g}\" Spacing=\"{:.17g}\">\n"
                  "<Piece Extent=\"{}\">\n<CellData Scalars=\"material\">\n"
                  "<DataArray type=\"UInt8\" Name=\"material\" format=\"appended\" offset=\"0\"/>\n"
                  "</CellData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_",
                  extent, fmt::join(image.origin, " "), fmt::join(image.spacing, " "), extent));
  const std::uint64_t size = grid.occupied.size();
  file.write({reinterpret_cast<const char*>(&size), sizeof size});
  file.write({reinterpret_cast<const char*>(grid.occupied.data()), grid.occupied.size()});
  file.write("\n</AppendedData>\n</VTKFile>\n");
}

} // namespace dss
