/// Bodies from arrays of NumPy.
#include "solver/error.hpp"
#include "solver/io/voxels/npy.hpp"
#include "tests/fixtures/own_directory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace dss {
namespace {

class Npy : public test::OwnDirectory {
protected:
  /// A file as numpy.save writes it.
  static std::string saved(const std::string& type, bool is_fortran, const std::string& shape,
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
      read_npy_voxels(written("a.npy", bytes), most);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("a.npy"), std::string::npos) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "accepted";
    return {};
  }
};

using Cells = std::vector<std::uint8_t>;

TEST_F(Npy, has_x_first_in_both_orders) {
  // a[x][y][z] of 2 x 3 x 1, elements at [1, 0, 0] and [0, 2, 0]
  const std::string c("\0\0\1\1\0\0", 6), fortran("\0\1\0\0\1\0", 6);
  for (const auto& [data, is_fortran] : {std::pair(c, false), std::pair(fortran, true)}) {
    const VoxelGrid grid =
        read_npy_voxels(written("a.npy", saved("|b1", is_fortran, "(2, 3, 1)", data)), 1000);
    EXPECT_EQ((std::array{grid.nx, grid.ny, grid.nz}), (std::array{2, 3, 1}));
    EXPECT_EQ(grid.occupied, (Cells{0, 1, 0, 0, 1, 0}));
  }
}

TEST_F(Npy, takes_numbers_of_any_width) {
  const double values[] = {0, 2, 0, 255};
  const std::string data(reinterpret_cast<const char*>(values), sizeof values);
  EXPECT_EQ(
      read_npy_voxels(written("a.npy", saved("<f8", false, "(4, 1, 1)", data)), 1000).occupied,
      (Cells{0, 2, 0, 255}));
  const std::int32_t whole[] = {7, 0};
  const std::string ints(reinterpret_cast<const char*>(whole), sizeof whole);
  EXPECT_EQ(read_npy_voxels(written("a.npy", saved("<i4", true, "(1, 1, 2)", ints)), 1000).occupied,
            (Cells{7, 0}));
}

TEST_F(Npy, refuses_what_is_no_body) {
  const auto says = [&](const std::string& bytes, const std::string& part, long most = 1000) {
    const std::string why = refusal(bytes, most);
    EXPECT_NE(why.find(part), std::string::npos) << why;
  };
  const std::string two("\1\0", 2);
  says("", "is no array of NumPy");
  says("plain text, long enough", "is no array of NumPy");
  says(saved("|u1", false, "(2, 1, 1)", two).substr(0, 40), "is cut off in its header");
  says(saved("|u1", false, "(2, 1, 1)", "\1"),
       "has 1 bytes of numbers; its shape [2, 1, 1] needs 2");
  says(saved("|u1", false, "(2, 1, 1)", two + two), "has 4 bytes of numbers");
  says(saved("|u1", false, "(2, 1)", two), "its shape is (2, 1); a body has three dimensions");
  says(saved("|u1", false, "()", "\1"), "three dimensions");
  says(saved("|u1", false, "(0, 1, 1)", ""), "is empty");
  says(saved("|u1", false, "(20, 10, 10)", std::string(2000, '\1')), "too many; at most 1000");
  says(saved("|u1", false, "(9000000000, 9000000000, 9000000000)", two), "too many");
  says(saved(">f8", false, "(1, 1, 1)", std::string(8, '\0')), "of the type \">f8\"");
  says(saved("<c16", false, "(1, 1, 1)", std::string(16, '\0')), "of the type \"<c16\"");
  const double between = 0.5, beyond = 256, below = -1;
  for (const double* wrong : {&between, &beyond, &below})
    says(saved("<f8", false, "(1, 1, 1)", {reinterpret_cast<const char*>(wrong), 8}),
         "at [0, 0, 0]; a cell is 0 (a hole) or the whole number of its material, up to 255");
  const double not_a_number = std::nan("");
  says(saved("<f8", false, "(1, 1, 1)", {reinterpret_cast<const char*>(&not_a_number), 8}),
       "nan at [0, 0, 0]");
  EXPECT_THROW(read_npy_voxels((directory / "none.npy").string(), 1000), InputError);
  EXPECT_THROW(read_npy_voxels(directory.string(), 1000), InputError);
}

TEST_F(Npy, that_are_written_are_read_again) {
  const VoxelGrid grid{3, 2, 2, {1, 0, 2, 0, 0, 255, 1, 1, 1, 0, 7, 0}};
  AtomicFile out(file("b.npy"));
  write_npy_voxels(out, grid);
  out.commit();
  const VoxelGrid again = read_npy_voxels(file("b.npy"), 1000);
  EXPECT_EQ((std::array{again.nx, again.ny, again.nz}), (std::array{3, 2, 2}));
  EXPECT_EQ(again.occupied, grid.occupied);
}

} // namespace
} // namespace dss
