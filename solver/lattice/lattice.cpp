#include "solver/lattice/lattice.hpp"

#include <algorithm>
#include <utility>

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

namespace {

/// The pieces of all rows, in their order.
class Pieces {
public:
  Pieces(const Lattice& whole, Lattice& cut) : whole_(whole), cut_(cut), rows_(cut.rows) {
    for (const Row& row : whole.rows) {
      first_.push_back(at_.size());
      std::size_t element = row.first_element;
      for (int n = first_piece(row); n <= last_piece(row); ++n) {
        const auto number = std::size_t(n);
        const int begin = n == 0 ? row.x_begin : std::max(row.x_begin, cut.cuts[number - 1]),
                  end =
                      number == cut.cuts.size() ? row.x_end : std::min(row.x_end, cut.cuts[number]);
        add(row, begin, end, element);
      }
    }
  }
  /// Sets the neighbours of all pieces.
  void join_all() {
    for (std::size_t r = 0; r < whole_.rows.size(); ++r) join_pieces(int(r));
  }

private:
  int first_piece(const Row& row) const { return cut_.piece_of(row.x_begin); }
  int last_piece(const Row& row) const { return cut_.piece_of(row.x_end - 1); }
  /// Adds the cells [begin, end) of a row, if one of them is present.
  void add(const Row& row, int begin, int end, std::size_t& element) {
    while (begin < end && !whole_.is_present(row, begin)) ++begin;
    while (begin < end && !whole_.is_present(row, end - 1)) --end;
    at_.push_back(begin < end ? int(rows_.size()) : -1);
    if (begin == end) return;
    Row& cut = rows_.emplace_back();
    cut.body = row.body, cut.y = row.y, cut.z = row.z;
    cut.x_begin = begin, cut.x_end = end;
    cut.first_element = element;
    cut.first_cell = row.first_cell + std::size_t(begin - row.x_begin);
    for (int x = begin; x < end; ++x) element += std::size_t(whole_.is_present(row, x));
  }
  /// The piece with this number of a row; -1: there is none.
  int piece_of(int r, int number) const {
    if (r < 0) return -1;
    const Row& row = whole_.rows[std::size_t(r)];
    const int first = first_piece(row);
    if (number < first || number > last_piece(row)) return -1;
    return at_[first_[std::size_t(r)] + std::size_t(number - first)];
  }
  void join_pieces(int r) {
    const Row& row = whole_.rows[std::size_t(r)];
    for (int number = first_piece(row); number <= last_piece(row); ++number) {
      const int own = piece_of(r, number), next = piece_of(r, number + 1);
      join(rows_, own, piece_of(row.upper_y, number), &Row::upper_y, &Row::lower_y);
      join(rows_, own, piece_of(row.upper_z, number), &Row::upper_z, &Row::lower_z);
      if (own >= 0 && next >= 0 &&
          rows_[std::size_t(own)].x_end == rows_[std::size_t(next)].x_begin)
        join(rows_, own, next, &Row::upper_x, &Row::lower_x);
    }
  }

  const Lattice& whole_;
  const Lattice& cut_; ///< says where
  std::vector<Row>& rows_;
  std::vector<std::size_t> first_; ///< of each whole row: its first in at_
  std::vector<int> at_;            ///< number among the rows; -1: no cell of the piece is present
};

} // namespace

Lattice cut_into_pieces(const Lattice& whole, std::vector<int> cuts) {
  Lattice cut{{}, whole.present, whole.element_count, 1, std::move(cuts)};
  Pieces(whole, cut).join_all();
  return cut;
}

// Rows side by side count even if no cell of one faces a cell of the other, because a loop over
// rows may read both.
int Lattice::row_reach() const {
  int reach = 0;
  for (int r = 0; r < int(rows.size()); ++r)
    for (const int axis : {0, 1, 2}) reach = std::max(reach, rows[std::size_t(r)].upper(axis) - r);
  return reach;
}

std::size_t Lattice::link_count() const {
  std::size_t count = 0;
  for_each_link([&](std::size_t, std::size_t, int) { ++count; });
  return count;
}

} // namespace dss
