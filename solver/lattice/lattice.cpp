#include "solver/lattice/lattice.hpp"

#include <algorithm>

namespace dss {
namespace {

/// Appends the row of cells (0 .. nx - 1, y, z) if one of them is occupied.
/// @return its number in the lattice, or -1
int append_row(Lattice& lattice, const VoxelGrid& grid, int body, int y, int z) {
  const auto nx = std::ptrdiff_t(grid.nx);
  const auto begin = grid.occupied.begin() + (std::ptrdiff_t(z) * grid.ny + y) * nx,
             end = begin + nx;
  const auto is_occupied = [](std::uint8_t cell) { return cell != 0; };
  const auto first = std::find_if(begin, end, is_occupied);
  if (first == end) return -1;
  auto last = end;
  while (!is_occupied(*(last - 1))) --last;
  Row row;
  row.body = body;
  row.y = y;
  row.z = z;
  row.x_begin = int(first - begin);
  row.x_end = int(last - begin);
  row.first_element = lattice.element_count;
  row.first_cell = lattice.present.size();
  for (auto cell = first; cell != last; ++cell) lattice.present.push_back(is_occupied(*cell));
  lattice.element_count += std::size_t(std::count_if(first, last, is_occupied));
  lattice.rows.push_back(row);
  return int(lattice.rows.size()) - 1;
}

void join(std::vector<Row>& rows, int lower, int upper, int Row::*to_upper, int Row::*to_lower) {
  if (lower < 0 || upper < 0) return;
  rows[std::size_t(lower)].*to_upper = upper;
  rows[std::size_t(upper)].*to_lower = lower;
}

} // namespace

void append_body(Lattice& lattice, const VoxelGrid& grid, int body) {
  std::vector<int> plane_below(std::size_t(grid.ny), -1), plane(std::size_t(grid.ny), -1);
  for (int z = 0; z < grid.nz; ++z) {
    for (int y = 0; y < grid.ny; ++y) {
      const auto here = std::size_t(y);
      plane[here] = append_row(lattice, grid, body, y, z);
      if (y > 0) join(lattice.rows, plane[here - 1], plane[here], &Row::upper_y, &Row::lower_y);
      join(lattice.rows, plane_below[here], plane[here], &Row::upper_z, &Row::lower_z);
    }
    std::swap(plane_below, plane);
  }
}

// Rows side by side count even if no cell of one faces a cell of the other, because a loop over
// rows may read both.
int Lattice::row_reach() const {
  int reach = 0;
  for (int r = 0; r < int(rows.size()); ++r)
    reach = std::max({reach, rows[std::size_t(r)].upper_y - r, rows[std::size_t(r)].upper_z - r});
  return reach;
}

std::size_t Lattice::link_count() const {
  std::size_t count = 0;
  for_each_link([&](std::size_t, std::size_t, int) { ++count; });
  return count;
}

} // namespace dss
