#pragma once
/// Geometry as rows. Every body is a set of cells of a regular grid, stored as rows of fixed (y, z)
/// (DESIGN.md section 4).
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dss {

/// One row of a body: the cells x_begin <= x < x_end at fixed (y, z). Cells between the ends may be
/// holes.
struct Row {
  int body = 0;
  int y = 0, z = 0;
  int x_begin = 0, x_end = 0;     ///< first present cell, one past the last present cell
  std::size_t first_element = 0;  ///< global number of the first present cell of the row
  std::size_t first_cell = 0;     ///< index of cell x_begin in Lattice::present
  int lower_x = -1, upper_x = -1; ///< of a cut row: linked pieces before and behind it, or -1
  int lower_y = -1, upper_y = -1; ///< row at y - 1, y + 1 of the same body and z, or -1
  int lower_z = -1, upper_z = -1; ///< row at z - 1, z + 1 of the same body and y, or -1

  /// The neighbour rows across axis 0 (x), 1 (y) or 2 (z).
  int lower(int axis) const { return axis == 0 ? lower_x : axis == 1 ? lower_y : lower_z; }
  int upper(int axis) const { return axis == 0 ? upper_x : axis == 1 ? upper_y : upper_z; }
};

/// The rows of all bodies, body by body, in each body by z, then y. Every row has a present cell.
/// Elements are the present cells, numbered in the order of rows, x fastest.
struct Lattice {
  std::vector<Row> rows;
  /// 1 for each present cell, 0 for each hole between x_begin and x_end, row after row.
  std::vector<std::uint8_t> present;
  std::size_t element_count = 0;
  /// Cells from an element to its neighbour along x. More than 1: so many bodies alternate along x
  /// (solver/model/ensemble.hpp).
  int x_stride = 1;
  /// Where rows are cut into pieces (cut_into_pieces): the first x of each piece but the first one.
  std::vector<int> cuts;

  bool is_present(const Row& row, int x) const {
    return x >= row.x_begin && x < row.x_end &&
           present[row.first_cell + std::size_t(x - row.x_begin)] != 0;
  }
  /// The number of the piece that a cell lies in, if rows are cut.
  int piece_of(int x) const {
    return int(std::upper_bound(cuts.begin(), cuts.end(), x) - cuts.begin());
  }
  /// Whether the cell at x, an element, has a link to the cell behind it.
  bool has_link_x(const Row& row, int x) const {
    return is_present(row, x + x_stride) || (row.upper_x >= 0 && x + 1 == row.x_end);
  }
  /// Largest distance in rows between linked elements; 0 if no link leaves a row. It is the depth
  /// of the halo of one stage, in rows.
  int row_reach() const;
  /// Number of links between faces inside the bodies, without extra links.
  std::size_t link_count() const;
  /// Calls visit(i, j, axis) for every link between element i and its neighbour j across the +axis
  /// face of i.
  template <class Visit>
  void for_each_link(Visit&& visit) const;
  /// Calls visit(element, row, x) for every element in order.
  template <class Visit>
  void for_each_element(Visit&& visit) const;
};

/// Occupied cells of one body: nx * ny * nz flags, x fastest, then y, then z.
struct VoxelGrid {
  int nx = 0, ny = 0, nz = 0;
  std::vector<std::uint8_t> occupied;
};

/// Appends the rows and elements of a body to the lattice; `body` is its index.
void append_body(Lattice& lattice, const VoxelGrid& grid, int body);

/// The same elements with the same numbers, in rows that are cut. Each piece is a row of its own;
/// pieces side by side are neighbours across y and z.
/// @param whole  its elements follow one another along x (x_stride is 1)
/// @param cuts   as Lattice::cuts, ascending
Lattice cut_into_pieces(const Lattice& whole, std::vector<int> cuts);

template <class Visit>
void Lattice::for_each_element(Visit&& visit) const {
  for (const Row& row : rows) {
    std::size_t element = row.first_element;
    for (int x = row.x_begin; x < row.x_end; ++x)
      if (is_present(row, x)) visit(element++, row, x);
  }
}

template <class Visit>
void Lattice::for_each_link(Visit&& visit) const {
  const auto across = [&](const Row& row, int upper, int axis) {
    if (upper < 0) return;
    const Row& other = rows[std::size_t(upper)];
    std::size_t i = row.first_element, j = other.first_element;
    for (int x = other.x_begin; x < row.x_begin; ++x) j += is_present(other, x);
    for (int x = row.x_begin; x < row.x_end; ++x) {
      const bool here = is_present(row, x), there = is_present(other, x);
      if (here && there) visit(i, j, axis);
      i += here;
      j += there;
    }
  };
  for (const Row& row : rows) {
    std::size_t i = row.first_element;
    for (int x = row.x_begin; x < row.x_end; ++x) {
      if (!is_present(row, x)) continue;
      if (has_link_x(row, x)) visit(i, i + std::size_t(x_stride), 0);
      ++i;
    }
    across(row, row.upper_y, 1);
    across(row, row.upper_z, 2);
  }
}

} // namespace dss
