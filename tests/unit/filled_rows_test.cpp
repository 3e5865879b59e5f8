#include "variants/engine/filled_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace dss {
namespace {

constexpr RowCosts nothing{0, 0}, of_rows{100, 0};

VoxelGrid sponge(int nx, int ny, int nz, unsigned seed) {
  VoxelGrid grid{nx, ny, nz, {}};
  std::mt19937 generator(seed);
  for (int cell = 0; cell < nx * ny * nz; ++cell) grid.occupied.push_back(generator() % 3 != 0);
  return grid;
}

/// Two bodies with holes, so that numbers of the second do not start at 0.
Lattice bodies(unsigned seed) {
  Lattice lattice;
  append_body(lattice, sponge(11, 4, 3, seed), 0);
  append_body(lattice, sponge(20, 5, 6, seed + 100), 1);
  return lattice;
}

struct Place {
  int row = -1, x = -1;
};
/// Of each element, where packs hold it.
std::vector<Place> places_of(const FilledRows& filled) {
  const Lattice& lattice = filled.lattice();
  std::vector<Place> places(lattice.element_count);
  for (int r = 0; r < int(lattice.rows.size()); ++r) {
    const Row& row = lattice.rows[std::size_t(r)];
    std::size_t number = row.first_element;
    for (int x = row.x_begin; x < row.x_end; ++x)
      if (lattice.is_present(row, x)) {
        EXPECT_EQ(filled.number_of(filled.element_at(number)), number);
        places[filled.element_at(number++)] = {r, x};
      }
  }
  return places;
}

bool keeps_numbers(const FilledRows& filled) {
  for (std::size_t element = 0; element < filled.lattice().element_count; ++element)
    if (filled.number_of(element) != element) return false;
  return true;
}

/// What the engine needs of any form: neighbours along x follow one another, and those across y and
/// z are in the row that the lattice names, in ascending order.
void expect_links_lead_to_upper_rows(const FilledRows& filled, const Lattice& cells) {
  const std::vector<Place> places = places_of(filled);
  for (const Place& place : places) ASSERT_GE(place.row, 0);
  std::vector<std::vector<std::array<int, 2>>> links(3 * filled.lattice().rows.size());
  cells.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    const Place own = places[i], other = places[j];
    if (axis == 0) {
      EXPECT_EQ(own.row, other.row);
      EXPECT_EQ(own.x + 1, other.x);
      return;
    }
    EXPECT_EQ(filled.lattice().rows[std::size_t(own.row)].upper(axis), other.row);
    EXPECT_EQ(filled.lattice().rows[std::size_t(other.row)].lower(axis), own.row);
    links[3 * std::size_t(own.row) + std::size_t(axis)].push_back({own.x, other.x});
  });
  for (std::vector<std::array<int, 2>>& of_row : links) {
    std::ranges::sort(of_row);
    for (std::size_t n = 1; n < of_row.size(); ++n) EXPECT_LT(of_row[n - 1][1], of_row[n][1]);
  }
}

TEST(FilledRows, OfAnyFormHaveTheLinksOfTheirCells) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Lattice cells = bodies(seed);
    for (const RowForm furthest : {RowForm::cells, RowForm::filled, RowForm::merged})
      for (const RowCosts second : {nothing, of_rows, RowCosts{0, 100}}) {
        const std::array costs{nothing, second};
        const FilledRows filled(cells, 8, costs, furthest);
        EXPECT_EQ(filled.is_any(), furthest != RowForm::cells);
        expect_links_lead_to_upper_rows(filled, cells);
      }
  }
}

TEST(FilledRows, HaveNoHoles) {
  const Lattice cells = bodies(1);
  const FilledRows filled(cells, 8, std::array{nothing, nothing}, RowForm::filled);
  for (const Row& row : filled.lattice().rows) {
    const std::size_t next =
        &row == &filled.lattice().rows.back() ? cells.element_count : (&row + 1)->first_element;
    EXPECT_EQ(row.x_begin, 0);
    EXPECT_EQ(std::size_t(row.x_end), next - row.first_element);
  }
  EXPECT_TRUE(keeps_numbers(filled));
}

TEST(FilledRows, OfAMergedBodyReachOneRow) {
  const Lattice cells = bodies(2);
  const FilledRows filled(cells, 8, std::array{of_rows, of_rows}, RowForm::merged);
  EXPECT_EQ(filled.lattice().rows.size(), std::size_t(4 + 3 - 1 + 5 + 6 - 1));
  EXPECT_EQ(filled.lattice().row_reach(), 1);
  EXPECT_FALSE(keeps_numbers(filled));
}

TEST(FilledRows, CountAsNeighboursWhatLiesBesideOneAnother) {
  Lattice cells;
  append_body(cells, {5, 2, 1, {1, 0, 1, 1, 0, /**/ 0, 1, 1, 0, 1}}, 0);
  EXPECT_EQ(neighbours_beside(cells, cells.rows[0], cells.rows[1]), (std::vector{-1, 1, -1}));
  EXPECT_EQ(neighbours_beside(cells, cells.rows[1], cells.rows[0]), (std::vector{-1, 1, -1}));
  EXPECT_TRUE(are_aligned(std::array{-1, 1, -1}));
  EXPECT_FALSE(are_aligned(std::array{-1, 0, -1}));
}

/// The form that a body of whole rows takes at the costs that the engine counts with.
RowForm form_of(const VoxelGrid& grid, LinkLaw law, int lanes) {
  Lattice cells;
  append_body(cells, grid, 0);
  const FilledRows filled(cells, lanes, std::array{row_costs(law, lanes)}, RowForm::merged);
  return filled.form(filled.lattice().rows.front());
}
VoxelGrid full(int nx, int ny, int nz) {
  return {nx, ny, nz,
          std::vector<std::uint8_t>(std::size_t(nx) * std::size_t(ny) * std::size_t(nz), 1)};
}

TEST(FilledRows, AreTakenWhereTheyFillPacks) {
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material}) {
    for (const int lanes : {1, 4, 8}) {
      EXPECT_EQ(form_of(full(100, 100, 1), law, lanes), RowForm::cells);
      EXPECT_EQ(form_of(full(16, 16, 16), law, lanes), RowForm::cells);
    }
    EXPECT_EQ(form_of(full(3, 12, 12), law, 8), RowForm::merged);
    EXPECT_EQ(form_of(full(3, 400, 400), law, 8), RowForm::cells) << "rows would be too long";
  }
  VoxelGrid comb = full(96, 10, 1);
  for (std::size_t cell = 0; cell < comb.occupied.size(); ++cell)
    comb.occupied[cell] = cell % 96 % 10 < 3;
  EXPECT_EQ(form_of(comb, LinkLaw::paper, 8), RowForm::filled);
}

} // namespace
} // namespace dss
