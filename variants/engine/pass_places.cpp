#include "variants/engine/pass_places.hpp"

#include <deque>

namespace dss {
namespace {

/// Numbered places of equal size, two rings for each writer: of what its own tile reads last, and
/// of what waits for another tile. Of a ring's free places the one that was given back first is
/// taken. Such a ring is as long as it must be and no longer, and its order in memory is that of
/// the writes.
class Rings {
public:
  explicit Rings(std::size_t writers) : rings_(2 * writers) {}
  int take(std::size_t writer, bool is_for_another_tile) {
    const std::size_t n = 2 * writer + std::size_t(is_for_another_tile);
    Ring& ring = rings_[n];
    if (ring.free.empty()) return int(n) + ring.count++ * int(rings_.size());
    const int place = ring.free.front();
    ring.free.pop_front();
    return place;
  }
  /// @param place  from take(), or nowhere
  void give(int place) {
    if (place != PassPlaces::nowhere)
      rings_[std::size_t(place) % rings_.size()].free.push_back(place);
  }
  /// Numbers all places ring after ring.
  /// @return their number
  int number(std::vector<std::vector<int>>& table) const {
    std::vector<int> begin{0};
    for (const Ring& ring : rings_) begin.push_back(begin.back() + ring.count);
    const int rings = int(rings_.size());
    for (std::vector<int>& places : table)
      for (int& place : places)
        if (place != PassPlaces::nowhere) place = begin[std::size_t(place % rings)] + place / rings;
    return begin.back();
  }

private:
  struct Ring {
    std::deque<int> free;
    int count = 0;
  };
  std::vector<Ring> rings_;
};

} // namespace

PassPlaces::PassPlaces(const Lattice& lattice, const RowOrder& rows,
                       std::span<const PassTask> order, int sweeps, int stages,
                       const std::vector<std::vector<int>>& increments,
                       std::span<const LinkedRows> extra, bool is_filled)
    : lattice_(lattice), rows_(rows), extra_(extra), is_filled_(is_filled) {
  find_rows(order);
  stage_rows_ = empty_table(stages - 1);
  for (Table& links : links_) links = empty_table(sweeps);
  place_stage_rows(order, stages, increments);
  for (const int axis : {1, 2}) place_links(order, axis);
}

void PassPlaces::find_rows(std::span<const PassTask> order) {
  int least = int(lattice_.rows.size()), most = -1;
  const auto add = [&](int r) {
    if (r >= 0) least = std::min(least, rows_.place(r)), most = std::max(most, rows_.place(r));
  };
  for (const PassTask& task : order) {
    if (task.work == RowWork::extra_link)
      add(extra_[std::size_t(task.row)].i), add(extra_[std::size_t(task.row)].j);
    if (task.is_extra()) continue;
    const Row& row = lattice_.rows[std::size_t(task.row)];
    for (const int r : {task.row, row.lower_y, row.lower_z, row.upper_y, row.upper_z}) add(r);
  }
  first_ = least;
  row_count_ = std::size_t(most + 1 - least);
}

void PassPlaces::place_stage_rows(std::span<const PassTask> order, int stages,
                                  const std::vector<std::vector<int>>& increments) {
  // Calls visit(stage, row) for each output of a stage that a task reads.
  const auto each_read = [&](const PassTask& task, auto&& visit) {
    const int stage = task.sweep % stages;
    if (stage > 0) each_input(lattice_, extra_, task, [&](int row) { visit(stage - 1, row); });
    if (task.work == RowWork::stage)
      for (const int m : increments[std::size_t(stage)]) visit(m, task.row);
  };
  Table last_read = empty_table(stages - 1);
  for (std::size_t n = 0; n < order.size(); ++n)
    each_read(order[n],
              [&](int stage, int row) { last_read[std::size_t(stage)][row_index(row)] = int(n); });
  Rings rings(stage_rows_.size());
  for (std::size_t n = 0; n < order.size(); ++n) {
    const PassTask& task = order[n];
    const auto stage = std::size_t(task.sweep % stages);
    if (task.work == RowWork::stage && stage < stage_rows_.size()) {
      const int last = last_read[stage][row_index(task.row)];
      const bool is_read = last != nowhere;
      int& place = stage_rows_[stage][row_index(task.row)];
      place = rings.take(stage, is_read && order[std::size_t(last)].tile != task.tile);
      if (!is_read) rings.give(place);
    }
    each_read(order[n], [&](int from, int read) {
      int& last = last_read[std::size_t(from)][row_index(read)];
      if (last != int(n)) return;
      last = nowhere; // a task may read a row twice
      rings.give(stage_rows_[std::size_t(from)][row_index(read)]);
    });
  }
  stage_row_count_ = rings.number(stage_rows_);
}

void PassPlaces::place_links(std::span<const PassTask> order, int axis) {
  const RowWork alone = axis == 1 ? RowWork::upper_link_y : RowWork::upper_link_z;
  const auto is_whole = [](const PassTask& task) {
    return task.work == RowWork::stage || task.work == RowWork::upper_links;
  };
  const auto has_lower = [&](const PassTask& task) {
    return is_whole(task) && lower(task.row, axis) >= 0;
  };
  Table& links = links_[std::size_t(axis) - 1];
  Table reader_tile = empty_table(int(links.size()));
  for (const PassTask& task : order)
    if (has_lower(task))
      reader_tile[std::size_t(task.sweep)][row_index(lower(task.row, axis))] = task.tile;
  Rings rings(links.size());
  for (const PassTask& task : order) {
    const auto sweep = std::size_t(task.sweep);
    const auto give = [&] {
      if (has_lower(task)) rings.give(links[sweep][row_index(lower(task.row, axis))]);
    };
    // A row reads what is left for it before it leaves its own in the same place.
    if (!is_filled_) give();
    if ((is_whole(task) || task.work == alone) && upper(task.row, axis) >= 0)
      links[sweep][row_index(task.row)] =
          rings.take(sweep, reader_tile[sweep][row_index(task.row)] != task.tile);
    if (is_filled_) give();
  }
  links_count_[std::size_t(axis) - 1] = rings.number(links);
}

} // namespace dss
