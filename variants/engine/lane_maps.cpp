#include "variants/engine/lane_maps.hpp"

#include <algorithm>

namespace dss {
namespace {

/// Of each element of a row, the x of its neighbour in the row beside it; -1 if there is none.
/// @param beside  the row of cells beside one of cells
std::vector<int> neighbours(const FilledRows& filled, const Lattice& cells, int row,
                            int Row::*beside) {
  std::vector<int> places;
  for (const int part : filled.parts(row)) {
    const Row& own = cells.rows[std::size_t(part)];
    const int other = own.*beside;
    const int first = other < 0 ? 0 : filled.first_place(other);
    const Row none{.x_begin = 0, .x_end = 0};
    for (const int number :
         neighbours_beside(cells, own, other < 0 ? none : cells.rows[std::size_t(other)]))
      places.push_back(number < 0 ? -1 : first + number);
  }
  return places;
}

} // namespace

template <class T>
LaneMaps<T>::LaneMaps(const FilledRows& filled, const Lattice& cells) {
  if (!filled.is_any()) return;
  const std::vector<Row>& rows = filled.lattice().rows;
  begin_.assign(rows.size(), -1);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (filled.form(rows[r]) == RowForm::cells) continue;
    const std::vector<int> to[] = {neighbours(filled, cells, int(r), &Row::upper_y),
                                   neighbours(filled, cells, int(r), &Row::upper_z),
                                   neighbours(filled, cells, int(r), &Row::lower_y),
                                   neighbours(filled, cells, int(r), &Row::lower_z)};
    if (std::ranges::all_of(to, are_aligned)) continue;
    begin_[r] = std::ptrdiff_t(maps_.size());
    for (int first = 0; first < rows[r].x_end; first += W) {
      const auto map = [&](const std::vector<int>& places) {
        return map_of(std::span(places).subspan(std::size_t(first),
                                                std::size_t(std::min(W, rows[r].x_end - first))));
      };
      maps_.push_back({map(to[0]), map(to[1]), map(to[2]), map(to[3])});
    }
  }
}

template <class T>
LaneMap<T> LaneMaps<T>::map_of(std::span<const int> places) {
  LaneMap<T> map;
  int least = -1, most = -1;
  for (const int place : places) {
    if (place < 0) continue;
    if (least < 0) least = place;
    most = place;
  }
  if (least < 0) return map;
  if (most / W > least / W + 1) {
    map.first = int(places_.size());
    map.second = -1;
    for (const int place : places) places_.push_back(place < 0 ? least : place);
    places_.resize(std::size_t(map.first + W), least);
    return map;
  }
  map.first = least / W, map.second = most / W;
  std::uint8_t* lane = map.lanes;
  for (const int place : places) {
    // Counted over both packs: those of the second follow the first's.
    if (place >= 0) *lane = std::uint8_t(place - map.first * W);
    ++lane;
  }
  return map;
}

template class LaneMaps<double>;
template class LaneMaps<float>;

} // namespace dss
