#include "variants/engine/filled_rows.hpp"

#include <algorithm>
#include <map>
#include <optional>

namespace dss {
namespace {

/// What another form must gain at least, since costs are estimates.
constexpr double least_gain = 0.05;
/// Longer merged rows gain no more, because what stages leave of them fills L2 (README.md).
constexpr int longest_merged = 1024; ///< [elements]

int element_count(const Lattice& cells, const Row& row) {
  const auto begin = cells.present.begin() + std::ptrdiff_t(row.first_cell);
  return int(std::count(begin, begin + (row.x_end - row.x_begin), std::uint8_t{1}));
}

int packs_for(int elements, int lanes) { return (elements + lanes - 1) / lanes; }

/// The rows of a body with the same y + z, in ascending z.
std::map<int, std::vector<int>> diagonals(const Lattice& cells, int begin, int end) {
  std::map<int, std::vector<int>> rows;
  for (int r = begin; r < end; ++r)
    rows[cells.rows[std::size_t(r)].y + cells.rows[std::size_t(r)].z].push_back(r);
  return rows;
}

/// The rows of a body, and what they cost.
struct BodyRows {
  const Lattice& cells;
  int begin, end, lanes;
  RowCosts costs;

  double as_cells() const {
    int packs = 0;
    for (int r = begin; r < end; ++r) {
      const Row& row = cells.rows[std::size_t(r)];
      packs += packs_for(row.x_end, lanes) - row.x_begin / lanes;
    }
    return costs.row * (end - begin) + packs;
  }
  /// @return nothing if it is not less than a limit
  std::optional<double> filled(double limit) const {
    double cost = costs.row * (end - begin);
    for (int r = begin; r < end; ++r)
      cost += packs_for(element_count(cells, cells.rows[std::size_t(r)]), lanes);
    for (int r = begin; r < end && cost < limit; ++r) {
      const Row& row = cells.rows[std::size_t(r)];
      const int packs = packs_for(element_count(cells, row), lanes);
      for (const int upper : {row.upper_y, row.upper_z})
        if (upper >= 0 &&
            !are_aligned(neighbours_beside(cells, row, cells.rows[std::size_t(upper)])))
          cost += costs.map * packs;
    }
    return cost < limit ? std::optional(cost) : std::nullopt;
  }
  /// @return nothing if the rows would be too long
  std::optional<double> merged() const {
    double cost = 0;
    for (const auto& [diagonal, rows] : diagonals(cells, begin, end)) {
      int elements = 0;
      for (const int r : rows) elements += element_count(cells, cells.rows[std::size_t(r)]);
      if (elements > longest_merged) return std::nullopt;
      cost += costs.row + (1 + 2 * costs.map) * packs_for(elements, lanes);
    }
    return cost;
  }
  RowForm best(RowForm furthest) const {
    RowForm best = RowForm::cells;
    double least = (1 - least_gain) * as_cells();
    const auto offer = [&](RowForm form, std::optional<double> cost) {
      if (cost && *cost < least) best = form, least = *cost;
    };
    if (furthest >= RowForm::filled) offer(RowForm::filled, filled(least));
    if (furthest >= RowForm::merged) offer(RowForm::merged, merged());
    return best;
  }
};

} // namespace

bool are_aligned(std::span<const int> neighbours) {
  for (std::size_t place = 0; place < neighbours.size(); ++place)
    if (neighbours[place] >= 0 && neighbours[place] != int(place)) return false;
  return true;
}

RowCosts row_costs(LinkLaw law, int lanes) {
  // Fitted to measured rates (README.md). A stage of the material law is longer.
  if (lanes == 1) return {0.2, 0.1};
  return law == LinkLaw::paper ? RowCosts{0.5, 0.3} : RowCosts{0.3, 0.15};
}

FilledRows::FilledRows(const Lattice& cells, int lanes, std::span<const RowCosts> costs,
                       RowForm furthest)
    : cells_(&cells) {
  const int rows = furthest == RowForm::cells ? 0 : int(cells.rows.size());
  struct Chosen {
    int begin, end;
    RowForm form;
  };
  std::vector<Chosen> bodies;
  bool is_any = false;
  for (int begin = 0, end = 0; begin < rows; begin = end) {
    const int body = cells.rows[std::size_t(begin)].body;
    while (end < rows && cells.rows[std::size_t(end)].body == body) ++end;
    const BodyRows of_body{cells, begin, end, lanes, costs[std::size_t(body)]};
    bodies.push_back({begin, end, of_body.best(furthest)});
    is_any |= bodies.back().form != RowForm::cells;
  }
  if (!is_any) return;
  forms_.resize(std::size_t(cells.rows.back().body) + 1);
  filled_ = {{}, cells.present, cells.element_count, cells.x_stride, {}};
  row_.resize(cells.rows.size());
  first_place_.resize(cells.rows.size());
  for (const auto& [begin, end, form] : bodies) take(begin, end, form);
  first_part_.push_back(int(parts_.size()));
  join_rows();
  number_elements();
}

void FilledRows::take(int begin, int end, RowForm form) {
  forms_[std::size_t(cells_->rows[std::size_t(begin)].body)] = form;
  if (form != RowForm::merged) {
    for (int r = begin; r < end; ++r) add(form, {&r, 1});
    return;
  }
  for (const auto& [diagonal, rows] : diagonals(*cells_, begin, end)) add(form, rows);
}

/// Adds a row that consists of some rows of cells.
void FilledRows::add(RowForm form, std::span<const int> parts) {
  Row row = cells_->rows[std::size_t(parts.front())];
  first_part_.push_back(int(parts_.size()));
  int place = 0;
  for (const int part : parts) {
    parts_.push_back(part);
    row_[std::size_t(part)] = int(filled_.rows.size());
    first_place_[std::size_t(part)] = place;
    place += element_count(*cells_, cells_->rows[std::size_t(part)]);
  }
  if (form == RowForm::merged) row.y += row.z, row.z = 0;
  if (form != RowForm::cells) {
    row.x_begin = 0, row.x_end = place;
    // Filled rows have no holes, so all share the cells behind those of the others.
    row.first_cell = cells_->present.size();
    const std::size_t present = row.first_cell + std::size_t(place);
    if (filled_.present.size() < present) filled_.present.resize(present, 1);
  }
  row.lower_y = row.upper_y = row.lower_z = row.upper_z = -1;
  filled_.rows.push_back(row);
}

void FilledRows::join_rows() {
  for (std::size_t r = 0; r < row_.size(); ++r) {
    const Row& of_cells = cells_->rows[r];
    Row& row = filled_.rows[std::size_t(row_[r])];
    const auto to = [&](int cell_row) { return row_[std::size_t(cell_row)]; };
    if (of_cells.upper_y >= 0) row.upper_y = to(of_cells.upper_y);
    if (of_cells.lower_y >= 0) row.lower_y = to(of_cells.lower_y);
    if (of_cells.upper_z >= 0) row.upper_z = to(of_cells.upper_z);
    if (of_cells.lower_z >= 0) row.lower_z = to(of_cells.lower_z);
  }
}

void FilledRows::number_elements() {
  std::vector<std::size_t> elements;
  bool is_changed = false;
  for (std::size_t r = 0; r < filled_.rows.size(); ++r) {
    filled_.rows[r].first_element = elements.size();
    for (const int part : parts(int(r))) {
      const Row& row = cells_->rows[std::size_t(part)];
      const int count = element_count(*cells_, row);
      is_changed |= row.first_element != elements.size();
      for (int n = 0; n < count; ++n) elements.push_back(row.first_element + std::size_t(n));
    }
  }
  if (!is_changed) return;
  elements_ = std::move(elements);
  numbers_.resize(elements_.size());
  for (std::size_t n = 0; n < elements_.size(); ++n) numbers_[elements_[n]] = n;
}

std::size_t FilledRows::bytes() const {
  return filled_.rows.size() * sizeof(Row) + filled_.present.size() +
         (numbers_.size() + elements_.size()) * sizeof(std::size_t) +
         (parts_.size() + first_part_.size() + row_.size() + first_place_.size()) * sizeof(int);
}

std::vector<int> neighbours_beside(const Lattice& cells, const Row& row, const Row& beside) {
  std::vector<int> numbers;
  numbers.reserve(std::size_t(row.x_end - row.x_begin));
  int number = 0;
  for (int x = beside.x_begin; x < row.x_begin; ++x) number += int(cells.is_present(beside, x));
  for (int x = row.x_begin; x < row.x_end; ++x) {
    const bool is_there = cells.is_present(beside, x);
    if (cells.is_present(row, x)) numbers.push_back(is_there ? number : -1);
    number += int(is_there);
  }
  return numbers;
}

} // namespace dss
