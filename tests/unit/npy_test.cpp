/// Bodies from arrays of NumPy.
#include "solver/error.hpp"
#include "solver/io/npy.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace dss {
namespace {

namespace fs = std::filesystem;

class Npy : public testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dss_npy_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string written(const std::string& bytes) const {
    std::ofstream(folder_ / "a.npy", std::ios::binary) << bytes;
    return (folder_ / "a.npy").string();
  }
  /// A file as numpy.save writes it.
  static std::string file(const std::string& type, bool is_fortran, const std::string& shape,
                          const std::string& data) {
    std::string header = "{'descr': '" + type +
                         "', 'fortran_order': " + (is_fortran ? "True" : "False") +
                         ", 'shape': " + shape + ", }";
    while ((10 + header.size() + 1) % 64 != 0) header += ' ';
    header += '\n';
    return std::string("\x93NUMPY\x01\x00", 8) + char(header.size()) + '\0' + header + data;
  }
  std::string refusal(const std::string& bytes, long most = 1000) const {
    try {
      read_npy_mask(written(bytes), most);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("a.npy"), std::string::npos) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "accepted";
    return {};
  }
  fs::path folder_;
};

using Cells = std::vector<std::uint8_t>;

TEST_F(Npy, has_x_first_in_both_orders) {
  // a[x][y][z] of 2 x 3 x 1, elements at [1, 0, 0] and [0, 2, 0]
  const std::string c("\0\0\1\1\0\0", 6), fortran("\0\1\0\0\1\0", 6);
  for (const auto& [data, is_fortran] : {std::pair(c, false), std::pair(fortran, true)}) {
    const NpyMask mask = read_npy_mask(written(file("|b1", is_fortran, "(2, 3, 1)", data)), 1000);
    EXPECT_EQ(mask.shape, (std::array<long, 3>{2, 3, 1}));
    EXPECT_EQ(mask.cells, (Cells{0, 1, 0, 0, 1, 0}));
  }
}

TEST_F(Npy, takes_numbers_of_any_width) {
  const double values[] = {0, 2.5, 0, 2.5};
  const std::string data(reinterpret_cast<const char*>(values), sizeof values);
  EXPECT_EQ(read_npy_mask(written(file("<f8", false, "(4, 1, 1)", data)), 1000).cells,
            (Cells{0, 1, 0, 1}));
  const std::int32_t whole[] = {7, 0};
  const std::string ints(reinterpret_cast<const char*>(whole), sizeof whole);
  EXPECT_EQ(read_npy_mask(written(file("<i4", true, "(1, 1, 2)", ints)), 1000).cells,
            (Cells{1, 0}));
}

TEST_F(Npy, refuses_what_is_no_body) {
  const auto says = [&](const std::string& bytes, const std::string& part, long most = 1000) {
    const std::string why = refusal(bytes, most);
    EXPECT_NE(why.find(part), std::string::npos) << why;
  };
  const std::string two("\1\0", 2);
  says("", "is no array of NumPy");
  says("plain text, long enough", "is no array of NumPy");
  says(file("|u1", false, "(2, 1, 1)", two).substr(0, 40), "is cut off in its header");
  says(file("|u1", false, "(2, 1, 1)", "\1"),
       "has 1 bytes of numbers; its shape [2, 1, 1] needs 2");
  says(file("|u1", false, "(2, 1, 1)", two + two), "has 4 bytes of numbers");
  says(file("|u1", false, "(2, 1)", two), "its shape is (2, 1); a body has three dimensions");
  says(file("|u1", false, "()", "\1"), "three dimensions");
  says(file("|u1", false, "(0, 1, 1)", ""), "is empty");
  says(file("|u1", false, "(20, 10, 10)", std::string(2000, '\1')), "too many; at most 1000");
  says(file("|u1", false, "(9000000000, 9000000000, 9000000000)", two), "too many");
  says(file(">f8", false, "(1, 1, 1)", std::string(8, '\0')), "of the type \">f8\"");
  says(file("<c16", false, "(1, 1, 1)", std::string(16, '\0')), "of the type \"<c16\"");
  says(file("|u1", false, "(2, 1, 1)", "\1\2"), "1 and 2 besides 0; a body has one material");
  const double not_a_number = std::nan("");
  says(file("<f8", false, "(1, 1, 1)", {reinterpret_cast<const char*>(&not_a_number), 8}),
       "besides 0");
  EXPECT_THROW(read_npy_mask((folder_ / "none.npy").string(), 1000), InputError);
  EXPECT_THROW(read_npy_mask(folder_.string(), 1000), InputError);
}

} // namespace
} // namespace dss
