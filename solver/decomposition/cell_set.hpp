#pragma once
/// Sets of cells of a lattice as intervals, so that work on rows without holes does not grow with
/// their length. Internal to this folder.
#include "solver/decomposition/share.hpp"
#include "solver/model/problem.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace dss {

/// A set of cells: segments ascending by row, then x. Two segments of a row have at least one cell
/// between them.
class CellSet {
public:
  CellSet() = default;
  /// From segments in any order, which may overlap or be empty.
  explicit CellSet(std::vector<Segment> segments);

  /// Adds a segment that begins at or after the begin of the last one.
  void append(const Segment& segment);
  bool contains(int row, int x) const;
  std::size_t cell_count() const;
  bool is_empty() const { return segments_.empty(); }
  const std::vector<Segment>& segments() const { return segments_; }
  bool operator==(const CellSet&) const = default;

private:
  std::vector<Segment> segments_;
};

/// difference: cells of a that are not in b. intersection: cells in both.
CellSet difference(const CellSet& a, const CellSet& b);
CellSet intersection(const CellSet& a, const CellSet& b);

/// A cell between x_begin and x_end of a row. It may be a hole.
struct Cell {
  int row = 0, x = 0;
};

/// The cells of a lattice: which of them are elements, and which are beside each other. Holds a
/// reference to the lattice.
class CellGrid {
public:
  explicit CellGrid(const Lattice& lattice) : lattice_(&lattice) {}
  explicit CellGrid(const Problem& problem); ///< with its extra links

  const Lattice& lattice() const { return *lattice_; }
  const Row& row(int r) const { return lattice_->rows[std::size_t(r)]; }
  std::size_t elements_of(int r) const;
  bool has_holes(int r) const {
    return elements_of(r) != std::size_t(row(r).x_end - row(r).x_begin);
  }
  std::size_t element_count(const Segment& segment) const;
  Cell cell_of(std::size_t element) const;
  /// Cells of all elements.
  CellSet all() const;
  /// Cells of a set that are elements. Below, a set is called present if all its cells are
  /// elements.
  CellSet present(const CellSet& set) const;
  /// A set, the cells beside it and the partners of its elements by extra links. The cells beside
  /// are x - 1 and x + 1 in the row, and the same x in the rows at y - 1, y + 1, z - 1, z + 1.
  /// Holes count as cells, so that the relation is symmetric.
  CellSet dilated(const CellSet& set) const;
  /// Calls visit(segment, number of its first element) for every longest run of present cells in a
  /// set, ascending.
  template <class Visit>
  void for_each_run(const CellSet& set, Visit&& visit) const;

private:
  Segment clipped(int r, int x_begin, int x_end) const;

  const Lattice* lattice_;
  std::vector<std::pair<Cell, Cell>> partners_; ///< of extra links, in both directions
};

template <class Visit>
void CellGrid::for_each_run(const CellSet& set, Visit&& visit) const {
  int counted_row = -1, x = 0;
  // Number of the first element at or after x in the counted row.
  std::size_t element = 0;
  for (const Segment& segment : set.segments()) {
    const Row& here = row(segment.row);
    if (!has_holes(segment.row)) {
      visit(segment, here.first_element + std::size_t(segment.x_begin - here.x_begin));
      continue;
    }
    if (segment.row != counted_row) {
      counted_row = segment.row;
      x = here.x_begin;
      element = here.first_element;
    }
    for (; x < segment.x_begin; ++x) element += lattice_->is_present(here, x);
    while (x < segment.x_end) {
      const int begin = x;
      while (x < segment.x_end && lattice_->is_present(here, x)) ++x;
      if (x > begin) visit(Segment{segment.row, begin, x}, element);
      element += std::size_t(x - begin);
      while (x < segment.x_end && !lattice_->is_present(here, x)) ++x;
    }
  }
}

} // namespace dss
