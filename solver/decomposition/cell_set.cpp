#include "solver/decomposition/cell_set.hpp"

#include <tuple>

namespace dss {
namespace {

bool begins_before(const Segment& a, const Segment& b) {
  return std::tie(a.row, a.x_begin) < std::tie(b.row, b.x_begin);
}

/// First segment that ends after cell x of the row, or that is in a later row.
std::vector<Segment>::const_iterator first_after(const std::vector<Segment>& segments, int row,
                                                 int x) {
  return std::upper_bound(
      segments.begin(), segments.end(), Cell{row, x}, [](const Cell& cell, const Segment& segment) {
        return std::tie(cell.row, cell.x) < std::tie(segment.row, segment.x_end);
      });
}

} // namespace

CellSet::CellSet(std::vector<Segment> segments) {
  if (!std::is_sorted(segments.begin(), segments.end(), begins_before))
    std::sort(segments.begin(), segments.end(), begins_before);
  segments_.reserve(segments.size());
  for (const Segment& segment : segments) append(segment);
}

void CellSet::append(const Segment& segment) {
  if (segment.x_begin >= segment.x_end) return;
  if (!segments_.empty() && segments_.back().row == segment.row &&
      segment.x_begin <= segments_.back().x_end)
    segments_.back().x_end = std::max(segments_.back().x_end, segment.x_end);
  else
    segments_.push_back(segment);
}

bool CellSet::contains(int row, int x) const {
  const auto found = first_after(segments_, row, x);
  return found != segments_.end() && found->row == row && found->x_begin <= x;
}

std::size_t CellSet::cell_count() const {
  std::size_t count = 0;
  for (const Segment& segment : segments_) count += std::size_t(segment.x_end - segment.x_begin);
  return count;
}

CellSet difference(const CellSet& a, const CellSet& b) {
  CellSet result;
  auto other = b.segments().begin();
  const auto end = b.segments().end();
  for (const Segment& segment : a.segments()) {
    while (other != end &&
           std::tie(other->row, other->x_end) <= std::tie(segment.row, segment.x_begin))
      ++other;
    int begin = segment.x_begin;
    for (auto hole = other;
         hole != end && hole->row == segment.row && hole->x_begin < segment.x_end; ++hole) {
      result.append({segment.row, begin, hole->x_begin});
      begin = hole->x_end;
    }
    result.append({segment.row, begin, segment.x_end});
  }
  return result;
}

CellSet intersection(const CellSet& a, const CellSet& b) {
  CellSet result;
  auto other = b.segments().begin();
  const auto end = b.segments().end();
  for (const Segment& segment : a.segments()) {
    while (other != end &&
           std::tie(other->row, other->x_end) <= std::tie(segment.row, segment.x_begin))
      ++other;
    for (auto both = other;
         both != end && both->row == segment.row && both->x_begin < segment.x_end; ++both)
      result.append({segment.row, std::max(segment.x_begin, both->x_begin),
                     std::min(segment.x_end, both->x_end)});
  }
  return result;
}

CellGrid::CellGrid(const Problem& problem) : lattice_(&problem.lattice) {
  for (const ExtraLink& link : problem.extra_links) {
    const Cell i = cell_of(link.i), j = cell_of(link.j);
    partners_.emplace_back(i, j);
    partners_.emplace_back(j, i);
  }
}

std::size_t CellGrid::elements_of(int r) const {
  const auto next = std::size_t(r) + 1;
  const std::size_t end =
      next < lattice_->rows.size() ? lattice_->rows[next].first_element : lattice_->element_count;
  return end - row(r).first_element;
}

std::size_t CellGrid::element_count(const Segment& segment) const {
  if (!has_holes(segment.row)) return std::size_t(segment.x_end - segment.x_begin);
  std::size_t count = 0;
  for (int x = segment.x_begin; x < segment.x_end; ++x)
    count += lattice_->is_present(row(segment.row), x);
  return count;
}

Cell CellGrid::cell_of(std::size_t element) const {
  const auto after =
      std::upper_bound(lattice_->rows.begin(), lattice_->rows.end(), element,
                       [](std::size_t e, const Row& row) { return e < row.first_element; });
  const int r = int(after - lattice_->rows.begin()) - 1;
  const Row& here = row(r);
  std::size_t further = element - here.first_element;
  if (!has_holes(r)) return {r, here.x_begin + int(further)};
  int x = here.x_begin; // a row begins with an element
  for (; further > 0; further -= lattice_->is_present(here, x)) ++x;
  return {r, x};
}

CellSet CellGrid::all() const {
  CellSet cells;
  for (int r = 0; r < int(lattice_->rows.size()); ++r)
    cells.append({r, row(r).x_begin, row(r).x_end});
  return present(cells);
}

CellSet CellGrid::present(const CellSet& set) const {
  CellSet elements;
  for_each_run(set, [&](const Segment& run, std::size_t) { elements.append(run); });
  return elements;
}

Segment CellGrid::clipped(int r, int x_begin, int x_end) const {
  return {r, std::max(x_begin, row(r).x_begin), std::min(x_end, row(r).x_end)};
}

// Each of the five directions gives ascending segments, because the rows of a body ascend by z,
// then y. Merging them costs less than sorting.
CellSet CellGrid::dilated(const CellSet& set) const {
  std::vector<Segment> wider;
  wider.reserve(5 * set.segments().size());
  const auto merge_from = [&](std::size_t sorted) {
    std::inplace_merge(wider.begin(), wider.begin() + std::ptrdiff_t(sorted), wider.end(),
                       begins_before);
  };
  for (const Segment& segment : set.segments())
    wider.push_back(clipped(segment.row, segment.x_begin - 1, segment.x_end + 1));
  for (int Row::*side : {&Row::lower_y, &Row::upper_y, &Row::lower_z, &Row::upper_z}) {
    const std::size_t sorted = wider.size();
    for (const Segment& segment : set.segments()) {
      const int beside = row(segment.row).*side;
      if (beside < 0) continue;
      const Segment next = clipped(beside, segment.x_begin, segment.x_end);
      if (next.x_begin < next.x_end) wider.push_back(next);
    }
    merge_from(sorted);
  }
  std::size_t sorted = wider.size();
  for (const auto& [cell, partner] : partners_)
    if (set.contains(cell.row, cell.x)) wider.push_back({partner.row, partner.x, partner.x + 1});
  std::sort(wider.begin() + std::ptrdiff_t(sorted), wider.end(), begins_before);
  merge_from(sorted);
  return CellSet(std::move(wider));
}

} // namespace dss
