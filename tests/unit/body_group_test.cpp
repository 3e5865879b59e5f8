/// Bodies that extra links join: how they are shifted, and in which direction they are swept.
#include "variants/engine/body_group.hpp"
#include "variants/engine/pass_order.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace dss {
namespace {

Lattice plates(const std::vector<std::pair<int, int>>& sizes) {
  Lattice lattice;
  for (int body = 0; body < int(sizes.size()); ++body) {
    const auto [ny, nz] = sizes[std::size_t(body)];
    append_body(lattice, {2, ny, nz, std::vector<std::uint8_t>(std::size_t(2 * ny * nz), 1)}, body);
  }
  return lattice;
}

TEST(BodyGroups, AreShiftedSoThatLinkedRowsAreClose) {
  const Lattice lattice = plates({{20, 1}, {30, 1}, {5, 1}});
  // The end of the first to the start of the second; the third is alone.
  const std::vector<LinkedRows> ends{{19, 20}};
  const std::vector<BodyGroup> groups = body_groups(lattice, {0, 55}, ends, false);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].lag(), 1);
  EXPECT_EQ(groups[0].members()[1].shift, 19);
  EXPECT_EQ(groups[0].planes(), 49);
  EXPECT_EQ(groups[0].rows_behind(), 2);
  EXPECT_FALSE(groups[1].is_linked());
  // Links that pull apart: each is two planes long, which is the least.
  const std::vector<LinkedRows> apart{{4, 20}, {0, 20}};
  EXPECT_EQ(body_groups(lattice, {0, 55}, apart, false).front().lag(), 3);
}

TEST(BodyGroups, ThatAreLinkedHaveNoRowsForTiles) {
  const Lattice lattice = plates({{9, 4}, {9, 7}});
  const std::vector<LinkedRows> in_first{{0, 9}}, between{{0, 36}};
  RowDivision division;
  division.cuts = {0, 99};
  EXPECT_EQ(most_rows_across(lattice, division, false, {}), 7);
  EXPECT_EQ(most_rows_across(lattice, division, false, in_first), 7);
  EXPECT_EQ(most_rows_across(lattice, division, false, between), 0);
  division.cuts = {0, 36};
  EXPECT_EQ(most_rows_across(lattice, division, false, {}), 4);
  division.order = RowOrder(lattice, in_first);
  EXPECT_EQ(most_rows_across(lattice, division, false, in_first), 7);
}

TEST(BodyGroups, TakeTheDirectionOfTheirLinks) {
  // Planes along the longer side of each body would put one row of links beside many planes.
  const Lattice lattice = plates({{20, 4}, {6, 20}});
  std::vector<LinkedRows> links;
  for (int z = 0; z < 4; ++z) links.push_back({z * 20, 80 + z * 6});
  const std::vector<BodyGroup> groups = body_groups(lattice, {0, 200}, links, false);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].lag(), 1);
}

} // namespace
} // namespace dss
