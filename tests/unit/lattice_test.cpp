#include "solver/lattice/lattice.hpp"
#include "solver/lattice/shape_digest.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>
#include <set>
#include <tuple>

namespace dss {
namespace {

VoxelGrid whole_grid(int nx, int ny, int nz) {
  return {nx, ny, nz,
          std::vector<std::uint8_t>(std::size_t(nx) * std::size_t(ny) * std::size_t(nz), 1)};
}

VoxelGrid scattered(int nx, int ny, int nz, unsigned seed) {
  VoxelGrid grid = whole_grid(nx, ny, nz);
  std::mt19937 generator(seed);
  for (auto& cell : grid.occupied) cell = generator() % 3 != 0;
  return grid;
}

using Link = std::tuple<std::size_t, std::size_t, int>;

/// Links found from a table of the cells, without rows.
std::set<Link> links_by_search(const VoxelGrid& grid, std::size_t first_element) {
  std::map<std::array<int, 3>, std::size_t> elements;
  std::size_t cell = 0, element = first_element;
  for (int z = 0; z < grid.nz; ++z)
    for (int y = 0; y < grid.ny; ++y)
      for (int x = 0; x < grid.nx; ++x)
        if (grid.occupied[cell++]) elements[{x, y, z}] = element++;
  std::set<Link> links;
  for (const auto& [place, i] : elements)
    for (int axis = 0; axis < 3; ++axis) {
      auto next = place;
      ++next[std::size_t(axis)];
      if (const auto j = elements.find(next); j != elements.end())
        links.insert({i, j->second, axis});
    }
  return links;
}

TEST(lattice, a_box_has_the_links_of_its_inner_faces) {
  Lattice lattice;
  append_body(lattice, whole_grid(5, 4, 3), 0);
  EXPECT_EQ(lattice.element_count, 60U);
  EXPECT_EQ(lattice.rows.size(), 12U);
  EXPECT_EQ(lattice.link_count(), 4U * 4 * 3 + 5U * 3 * 3 + 5U * 4 * 2);
}

TEST(lattice, rows_reach_one_row_in_a_plate_and_a_plane_in_a_block) {
  Lattice row, plate, block;
  append_body(row, whole_grid(9, 1, 1), 0);
  append_body(plate, whole_grid(9, 7, 1), 0);
  append_body(block, whole_grid(9, 7, 2), 0);
  EXPECT_EQ(row.row_reach(), 0);
  EXPECT_EQ(plate.row_reach(), 1);
  EXPECT_EQ(block.row_reach(), 7);
}

TEST(lattice, links_of_any_mask_are_those_between_neighbouring_cells) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Lattice lattice;
    append_body(lattice, whole_grid(2, 1, 1), 0); // so that numbers do not start at 0
    const VoxelGrid grid = scattered(7, 5, 4, seed);
    append_body(lattice, grid, 1);
    std::set<Link> expected = links_by_search(grid, 2), found;
    expected.insert({0, 1, 0});
    lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
      EXPECT_TRUE(found.insert({i, j, axis}).second) << "link visited twice";
    });
    EXPECT_EQ(found, expected) << "seed " << seed;
  }
}

TEST(lattice, cut_rows_have_the_same_elements_and_links) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Lattice whole;
    append_body(whole, scattered(9, 5, 3, seed), 0);
    append_body(whole, whole_grid(7, 2, 1), 1);
    const Lattice cut =
        cut_into_pieces(whole, seed % 2 == 0 ? std::vector{4} : std::vector{1, 2, 6});
    const auto links_of = [](const Lattice& lattice) {
      std::set<Link> links;
      lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
        EXPECT_TRUE(links.insert({i, j, axis}).second) << "link visited twice";
      });
      return links;
    };
    EXPECT_EQ(links_of(cut), links_of(whole)) << "seed " << seed;
    std::vector<std::array<int, 4>> cells[2];
    for (const bool is_cut : {false, true})
      (is_cut ? cut : whole).for_each_element([&](std::size_t element, const Row& row, int x) {
        EXPECT_EQ(element, cells[is_cut].size());
        cells[is_cut].push_back({row.body, row.z, row.y, x});
      });
    EXPECT_EQ(cells[0], cells[1]);
    for (const Row& row : cut.rows)
      EXPECT_EQ(cut.piece_of(row.x_begin), cut.piece_of(row.x_end - 1));
  }
}

TEST(lattice, elements_are_visited_in_order_of_z_then_y_then_x) {
  Lattice lattice;
  append_body(lattice, scattered(6, 5, 3, 1), 0);
  std::size_t count = 0;
  std::array<int, 3> last = {-1, -1, -1};
  lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    EXPECT_EQ(element, count++);
    const std::array<int, 3> place = {row.z, row.y, x};
    EXPECT_LT(last, place);
    last = place;
  });
  EXPECT_EQ(count, lattice.element_count);
}

TEST(lattice, rows_without_a_cell_do_not_exist_and_cut_the_neighbourhood) {
  VoxelGrid grid = whole_grid(3, 3, 1);
  for (std::size_t x = 0; x < 3; ++x) grid.occupied[3 + x] = 0;
  Lattice lattice;
  append_body(lattice, grid, 0);
  ASSERT_EQ(lattice.rows.size(), 2U);
  EXPECT_EQ(lattice.rows[0].upper_y, -1);
  EXPECT_EQ(lattice.rows[1].lower_y, -1);
  EXPECT_EQ(lattice.rows[1].y, 2);
  EXPECT_EQ(lattice.link_count(), 4U);
}

TEST(lattice, a_row_is_trimmed_to_its_cells_and_keeps_its_holes) {
  Lattice lattice;
  append_body(lattice, {6, 1, 1, {0, 1, 0, 1, 1, 0}}, 0);
  const Row& row = lattice.rows.at(0);
  EXPECT_EQ(row.x_begin, 1);
  EXPECT_EQ(row.x_end, 5);
  EXPECT_FALSE(lattice.is_present(row, 0));
  EXPECT_TRUE(lattice.is_present(row, 1));
  EXPECT_FALSE(lattice.is_present(row, 2));
  EXPECT_FALSE(lattice.is_present(row, 5));
  EXPECT_EQ(lattice.element_count, 3U);
}

/// Two rows of three cells in all: 2 and 1, or 1 and 2.
TEST(lattice, digests_of_shapes_tell_where_rows_end) {
  Lattice first, second;
  append_body(first, {2, 2, 1, {1, 1, 1, 0}}, 0);
  append_body(second, {2, 2, 1, {1, 0, 1, 1}}, 0);
  EXPECT_EQ(first.present, second.present);
  EXPECT_NE(shape_digest(first), shape_digest(second));
  EXPECT_EQ(shape_digest(first), shape_digest(Lattice(first)));
}

} // namespace
} // namespace dss
