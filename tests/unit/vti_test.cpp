/// Bodies from image data of VTK, and from plain arrays.
#include "solver/error.hpp"
#include "solver/io/base64.hpp"
#include "solver/io/voxels/voxel_numbers.hpp"
#include "solver/io/voxels/vti.hpp"
#include "tests/fixtures/own_directory.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <zlib.h>

namespace dss {
namespace {

using Cells = std::vector<std::uint8_t>;

std::string words(std::initializer_list<std::uint32_t> numbers) {
  std::string bytes;
  for (const std::uint32_t number : numbers)
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  return bytes;
}

const std::string cells_u8("\1\0\2\0\0\3", 6); // 3 x 2 x 1
constexpr const char* cells_extent = "0 3 0 2 0 1";

class Vti : public test::OwnDirectory {
protected:
  static std::string image(const std::string& data, const std::string& attributes = "",
                           const std::string& extent = cells_extent, const char* of = "CellData",
                           const std::string& tail = "") {
    return fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\"{}>\n"
        "<ImageData WholeExtent=\"{}\" Origin=\"1 2 3\" Spacing=\"0.5 0.25 2\">\n"
        "<Piece Extent=\"{}\">\n<{}>{}</{}></Piece></ImageData>{}</VTKFile>",
        attributes, extent, extent, of, data, of, tail);
  }
  static std::string array(const std::string& format, const std::string& content,
                           const std::string& type = "UInt8") {
    return fmt::format("<DataArray type=\"{}\" Name=\"m\" {}>{}</DataArray>", type, format,
                       content);
  }
  ImageVoxels read(const std::string& text, const std::string& name = "") const {
    return read_vti_voxels(written("a.vti", text), name, 1000);
  }
  void refuses(const std::string& text, const std::string& part,
               const std::string& name = "") const {
    try {
      read(text, name);
      ADD_FAILURE() << "accepted: " << part;
    } catch (const InputError& error) {
      const std::string why = error.what();
      EXPECT_EQ(why.find('\n'), std::string::npos) << why;
      EXPECT_NE(why.find("a.vti"), std::string::npos) << why;
      EXPECT_NE(why.find(part), std::string::npos) << why;
    }
  }
};

const std::string text_array_head = "format=\"ascii\"";

TEST_F(Vti, is_read_from_text_base64_and_appended_bytes) {
  const std::string sized = words({6}) + cells_u8;
  for (const std::string& file :
       {image(array(text_array_head, "1 0 2\n0 0 3")),
        image(array("format=\"binary\"", base64(sized))),
        image(array("format=\"appended\" offset=\"0\"", ""), "", cells_extent, "CellData",
              "<AppendedData encoding=\"raw\">_" + sized + "</AppendedData>"),
        image(array("format=\"appended\" offset=\"0\"", ""), "", cells_extent, "CellData",
              "<AppendedData encoding=\"base64\">_" + base64(sized) + "</AppendedData>")}) {
    const ImageVoxels voxels = read(file);
    EXPECT_EQ((std::array{voxels.grid.nx, voxels.grid.ny, voxels.grid.nz}), (std::array{3, 2, 1}));
    EXPECT_EQ(voxels.grid.occupied, (Cells{1, 0, 2, 0, 0, 3}));
    EXPECT_EQ(voxels.spacing, (Vec3{0.5, 0.25, 2}));
    EXPECT_EQ(voxels.origin, (Vec3{1, 2, 3}));
  }
}

TEST_F(Vti, is_read_compressed_in_blocks) {
  const auto packed = [](const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string out(size, '\0');
    compress(reinterpret_cast<Bytef*>(out.data()), &size,
             reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    out.resize(size);
    return out;
  };
  const std::string first = packed(cells_u8.substr(0, 4)), second = packed(cells_u8.substr(4));
  const std::string head =
      words({2, 4, 2, std::uint32_t(first.size()), std::uint32_t(second.size())});
  const std::string attributes = " compressor=\"vtkZLibDataCompressor\"",
                    inline_data = base64(head) + base64(first + second);
  EXPECT_EQ(read(image(array("format=\"binary\"", inline_data), attributes)).grid.occupied,
            (Cells{1, 0, 2, 0, 0, 3}));
  const auto appended = [&](const std::string& data) {
    return image(array("format=\"appended\" offset=\"0\"", ""), attributes, cells_extent,
                 "CellData", "<AppendedData encoding=\"raw\">_" + data);
  };
  EXPECT_EQ(read(appended(head + first + second)).grid.occupied, (Cells{1, 0, 2, 0, 0, 3}));
  std::string damaged = head + first + second;
  damaged[damaged.size() - 3] ^= 1;
  refuses(appended(damaged), "a compressed block is damaged");
  refuses(appended(head + first), "a compressed block is damaged");
  refuses(appended(head.substr(0, 7)), "cut off");
  refuses(appended(words({4000000000U, 4, 0})), "cut off");
  refuses(appended(words({1, 4000000000U, 0, 3}) + "abc"), "do not have the size");
}

TEST_F(Vti, has_cells_around_the_points_of_point_data) {
  const ImageVoxels voxels =
      read(image(array(text_array_head, "1 0 2 0 0 3"), "", "1 3 0 1 0 0", "PointData"));
  EXPECT_EQ((std::array{voxels.grid.nx, voxels.grid.ny, voxels.grid.nz}), (std::array{3, 2, 1}));
  EXPECT_EQ(voxels.origin, (Vec3{1.25, 1.875, 2}));
}

TEST_F(Vti, that_is_written_is_read_again) {
  const ImageVoxels image{{2, 1, 3, {1, 0, 9, 255, 0, 0}}, {0.1, 0.2, 0.3}, {-1, 0, 1}};
  AtomicFile out(file("b.vti"));
  write_vti_voxels(out, image);
  out.commit();
  const ImageVoxels again = read_vti_voxels(file("b.vti"), "material", 1000);
  EXPECT_EQ(again.grid.occupied, image.grid.occupied);
  EXPECT_EQ(again.spacing, image.spacing);
  EXPECT_EQ(again.origin, image.origin);
}

TEST_F(Vti, is_refused_where_it_is_no_body) {
  const std::string good = array(text_array_head, "1 0 2 0 0 3");
  refuses("", "no XML of VTK");
  refuses("<VTKFile><PolyData/></VTKFile>", "no ImageData");
  refuses(image(good, "", "0 3 0 2"), "no Extent");
  refuses(image(good, "", "-9223372036854775808 9223372036854775807 0 2 0 1"), "Extent");
  refuses(image(good, "", "3 0 0 2 0 1"), "Extent");
  refuses(image(good + good), "its arrays are: m, m");
  refuses(image(good), "its arrays are: m; name one", "other");
  refuses(image(""), "its arrays are: ;");
  refuses(image(array(text_array_head, "1 0 2")), "has 3 bytes of numbers");
  refuses(image(array(text_array_head, "1 0 2 0 0 300")), "it has 300");
  refuses(image(array(text_array_head, "1 0 2 0 0 3", "Float64")), "wide type");
  refuses(image(array("format=\"binary\"", "*")), "other characters");
  refuses(image(array("format=\"binary\"", base64(words({60}) + cells_u8))), "cut off");
  refuses(image(array("format=\"appended\" offset=\"9\"", "")), "appended data are cut off");
  refuses(image(good, "", "0 300 0 200 0 100"), "too many");
  refuses(image(array(text_array_head, "0", "String")), "of the type \"String\"");
  std::string big = image(good);
  refuses(big.replace(big.find("Little"), 6, "Big"), "big-endian");
  std::string turned = image(good);
  refuses(turned.replace(turned.find(" Origin"), 1, " Direction=\"0 1 0 1 0 0 0 0 1\" "), "turned");
  EXPECT_THROW(read_vti_voxels(file("none.vti"), "", 1000), InputError);
}

TEST_F(Vti, beside_plain_arrays_of_numbers) {
  const std::string path = written("a.raw", std::string("\1\0\0\0\2\0\3\0", 8));
  const NumberType& u2 = *std::ranges::find(number_types(), "u2", &NumberType::name);
  const NumberType& u1 = *std::ranges::find(number_types(), "u1", &NumberType::name);
  EXPECT_EQ(read_raw_voxels(path, {2, 1, 2}, u2, 1000).occupied, (Cells{1, 0, 2, 3}));
  EXPECT_THROW(read_raw_voxels(path, {2, 1, 2}, u1, 1000), InputError);
  EXPECT_THROW(read_raw_voxels(path, {2, 0, 2}, u2, 1000), InputError);
}

TEST(Base64, is_that_of_rfc_4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xff\xfe"), "///+");
}

} // namespace
} // namespace dss
