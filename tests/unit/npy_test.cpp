/// Bodies from arrays of NumPy.
#include "solver/error.hpp"
#include "solver/io/npy.hpp"
#include "tests/fixtures/own_directory.hpp"

#include <gtest/gtest.h>

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
      read_npy_mask(written("a.npy", bytes), most);
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
    const NpyMask mask =
        read_npy_mask(written("a.npy", saved("|b1", is_fortran, "(2, 3, 1)", data)), 1000);
    EXPECT_EQ(mask.shape, (std::array<long, 3>{2, 3, 1}));
    EXPECT_EQ(mask.cells, (Cells{0, 1, 0, 0, 1, 0}));
  }
}

TEST_F(Npy, takes_numbers_of_any_width) {
  const double values[] = {0, 2.5, 0, 2.5};
  const std::string data(reinterpret_cast<const char*>(values), sizeof values);
  EXPECT_EQ(read_npy_mask(written("a.npy", saved("<f8", false, "(4, 1, 1)", data)), 1000).cells,
            (Cells{0, 1, 0, 1}));
  const std::int32_t whole[] = {7, 0};
  const std::string ints(reinterpret_cast<const char*>(whole), sizeof whole);
  EXPECT_EQ(read_npy_mask(written("a.npy", saved("<i4", true, "(1, 1, 2)", ints)), 1000).cells,
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
  says(saved("|u1", false, "(2, 1, 1)", "\1\2"), "1 and 2 besides 0; a body has one material");
  const double not_a_number = std::nan("");
  says(saved("<f8", false, "(1, 1, 1)", {reinterpret_cast<const char*>(&not_a_number), 8}),
       "besides 0");
  EXPECT_THROW(read_npy_mask((directory / "none.npy").string(), 1000), InputError);
  EXPECT_THROW(read_npy_mask(directory.string(), 1000), InputError);
}

} // namespace
} // namespace dss
