#pragma once
/// Rows as packs hold them. Packs on the grid of cells are cheap where rows are long and whole. A
/// row is *filled* if its packs hold its elements one after the other, without its holes. Rows are
/// *merged* if all rows of a body with the same y + z, of which no two have a link, are one filled
/// row. In filled rows, neighbours lie in different lanes, and maps say in which (lane_maps.hpp).
#include "solver/lattice/lattice.hpp"
#include "solver/model/problem.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace dss {

/// Calls visit(element, x) for every present cell of a row, in ascending x.
template <class Visit>
void each_cell(const Lattice& lattice, const Row& row, Visit&& visit) {
  std::size_t element = row.first_element;
  for (int x = row.x_begin; x < row.x_end; ++x)
    if (lattice.is_present(row, x)) visit(element++, x);
}

/// How the rows of a body are held. Each form may also take those before it.
enum class RowForm : std::uint8_t { cells, filled, merged };

/// Costs of a body's rows over that of a stage of one pack: of a row, whatever its length, and of a
/// pack that finds the elements of a row beside it by a map.
struct RowCosts {
  double row, map;
};
/// @param lanes  of a pack
RowCosts row_costs(LinkLaw law, int lanes);

/// A lattice as packs hold it, with each body in the form that takes the least time.
class FilledRows {
public:
  /// @param cells     outlives this object
  /// @param lanes     of a pack
  /// @param costs     of each body
  /// @param furthest  no form after this one is taken
  FilledRows(const Lattice& cells, int lanes, std::span<const RowCosts> costs, RowForm furthest);
  /// The rows that packs hold, with x counted in lanes. In a filled row, x is the number of an
  /// element in its row. Elements have numbers of their own; without merged rows the same ones.
  const Lattice& lattice() const { return is_any() ? filled_ : *cells_; }
  bool is_any() const { return !forms_.empty(); }
  RowForm form(const Row& row) const {
    return is_any() ? forms_[std::size_t(row.body)] : RowForm::cells;
  }
  /// From an element of the cells to its number in lattice(), and back.
  std::size_t number_of(std::size_t element) const {
    return numbers_.empty() ? element : numbers_[element];
  }
  std::size_t element_at(std::size_t number) const {
    return elements_.empty() ? number : elements_[number];
  }
  /// The rows of cells of which a row consists, in the order of its elements. Only if is_any().
  std::span<const int> parts(int row) const {
    return std::span(parts_).subspan(
        std::size_t(first_part_[std::size_t(row)]),
        std::size_t(first_part_[std::size_t(row) + 1] - first_part_[std::size_t(row)]));
  }
  /// The row that holds a row of cells.
  int row(int cell_row) const { return is_any() ? row_[std::size_t(cell_row)] : cell_row; }
  /// The x of the first element of a filled row of cells.
  int first_place(int cell_row) const { return first_place_[std::size_t(cell_row)]; }
  /// Calls visit(element, its x, its x in lattice()) for each element of a row of cells.
  template <class Visit>
  void each_of_cells(int cell_row, Visit&& visit) const;
  /// Calls visit(row of cells, x in that row, x in lattice()) for each element of a row.
  template <class Visit>
  void each_element(int row, Visit&& visit) const {
    for (const int part : is_any() ? parts(row) : std::span(&row, 1))
      each_of_cells(part, [&](std::size_t, int x, int place) {
        visit(cells_->rows[std::size_t(part)], x, place);
      });
  }
  std::size_t bytes() const;

private:
  /// Adds the rows of a body, which are [begin, end) of the cells.
  void take(int begin, int end, RowForm form);
  void add(RowForm form, std::span<const int> parts);
  /// Sets the rows beside each row.
  void join_rows();
  void number_elements();

  const Lattice* cells_;
  std::vector<RowForm> forms_; ///< of each body; empty if all rows are those of the cells
  Lattice filled_;
  std::vector<int> parts_, first_part_; ///< of each row
  std::vector<int> row_, first_place_;  ///< of each row of cells
  std::vector<std::size_t> numbers_, elements_;
};

template <class Visit>
void FilledRows::each_of_cells(int cell_row, Visit&& visit) const {
  const Row& row = cells_->rows[std::size_t(cell_row)];
  const bool is_filled = form(row) != RowForm::cells;
  int place = is_filled ? first_place(cell_row) : 0;
  each_cell(*cells_, row,
            [&](std::size_t element, int x) { visit(element, x, is_filled ? place++ : x); });
}

/// Of each element of a filled row of cells, the number of its neighbour among the elements of a
/// row beside it, in ascending order; -1 if there is none.
std::vector<int> neighbours_beside(const Lattice& cells, const Row& row, const Row& beside);
/// Whether each neighbour has the place of its element.
bool are_aligned(std::span<const int> neighbours);

} // namespace dss
