#include "variants/engine/pass_places.hpp"

#include <deque>

namespace dss {
namespace {

/// Numbered places. For each writer and size there are two rings: of what its own tile reads last,
/// and of what waits for another tile. Of a ring's free places the one that was given back first is
/// taken. Such a ring is as long as it must be and no longer, and its order in memory is that of
/// the writes.
class Rings {
public:
  /// @param sizes  of each row's place; empty: 1
  Rings(std::size_t writers, std::span<const int> sizes) : of_row_(sizes), sizes_{1} {
    if (!sizes.empty()) sizes_.assign(sizes.begin(), sizes.end());
    std::ranges::sort(sizes_);
    sizes_.erase(std::unique(sizes_.begin(), sizes_.end()), sizes_.end());
    rings_.resize(2 * writers * sizes_.size());
  }
  int take(std::size_t writer, int row, bool is_for_another_tile) {
    const std::size_t n =
        (2 * writer + std::size_t(is_for_another_tile)) * sizes_.size() + index_of_size(row);
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
  /// Puts all places one behind the other, ring after ring.
  /// @return their size
  int put_in_order(std::vector<std::vector<int>>& table) const {
    std::vector<int> begin{0};
    for (std::size_t n = 0; n < rings_.size(); ++n)
      begin.push_back(begin.back() + rings_[n].count * size(n));
    for (std::vector<int>& places : table)
      for (int& place : places)
        if (place != PassPlaces::nowhere) {
          const std::size_t ring = std::size_t(place) % rings_.size();
          place = begin[ring] + place / int(rings_.size()) * size(ring);
        }
    return begin.back();
  }

private:
  std::size_t index_of_size(int row) const {
    if (of_row_.empty()) return 0;
    return std::size_t(std::ranges::lower_bound(sizes_, of_row_[std::size_t(row)]) -
                       sizes_.begin());
  }
  int size(std::size_t ring) const { return sizes_[ring % sizes_.size()]; }
  struct Ring {
    std::deque<int> free;
    int count = 0;
  };
  const std::span<const int> of_row_;
  std::vector<int> sizes_; ///< all, ascending
  std::vector<Ring> rings_;
};

} // namespace

PassPlaces::PassPlaces(const Lattice& lattice, const RowOrder& rows,
                       std::span<const PassTask> order, int sweeps, StepSweeps of_step,
                       const std::vector<std::vector<int>>& increments,
                       std::span<const LinkedRows> extra, bool is_filled, PlaceSizes sizes)
    : lattice_(lattice), rows_(rows), extra_(extra), is_filled_(is_filled), sizes_(sizes) {
  find_rows(order);
  stage_rows_ = empty_table(of_step.stages - 1);
  for (Table& links : links_) links = empty_table(sweeps);
  place_stage_rows(order, of_step, increments);
  for (const int axis : {0, 1, 2}) place_links(order, axis);
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
    add(task.row);
    for (const int axis : {0, 1, 2}) add(row.lower(axis)), add(row.upper(axis));
  }
  first_ = least;
  row_count_ = std::size_t(most + 1 - least);
}

void PassPlaces::place_stage_rows(std::span<const PassTask> order, StepSweeps of_step,
                                  const std::vector<std::vector<int>>& increments) {
  // Calls visit(stage, row) for each output of a stage that a task reads.
  const auto each_read = [&](const PassTask& task, auto&& visit) {
    const int stage = of_step.stage(task.sweep);
    if (stage > 0) each_input(lattice_, extra_, task, [&](int row) { visit(stage - 1, row); });
    if (task.work == RowWork::stage)
      for (const int m : increments[std::size_t(stage)]) visit(m, task.row);
  };
  Table last_read = empty_table(of_step.stages - 1);
  for (std::size_t n = 0; n < order.size(); ++n)
    each_read(order[n],
              [&](int stage, int row) { last_read[std::size_t(stage)][row_index(row)] = int(n); });
  Rings rings(stage_rows_.size(), sizes_.stages);
  for (std::size_t n = 0; n < order.size(); ++n) {
    const PassTask& task = order[n];
    const auto stage = std::size_t(of_step.stage(task.sweep));
    if (task.work == RowWork::stage && stage < stage_rows_.size()) {
      const int last = last_read[stage][row_index(task.row)];
      const bool is_read = last != nowhere;
      int& place = stage_rows_[stage][row_index(task.row)];
      place = rings.take(stage, task.row, is_read && order[std::size_t(last)].tile != task.tile);
      if (!is_read) rings.give(place);
    }
    each_read(order[n], [&](int from, int read) {
      int& last = last_read[std::size_t(from)][row_index(read)];
      if (last != int(n)) return;
      last = nowhere; // a task may read a row twice
      rings.give(stage_rows_[std::size_t(from)][row_index(read)]);
    });
  }
  stage_rows_size_ = rings.put_in_order(stage_rows_);
}

void PassPlaces::place_links(std::span<const PassTask> order, int axis) {
  const auto has_lower = [&](const PassTask& task) {
    return reads_links(task.work) && lower(task.row, axis) >= 0;
  };
  Table& links = links_[std::size_t(axis)];
  Table reader_tile = empty_table(int(links.size()));
  for (const PassTask& task : order)
    if (has_lower(task))
      reader_tile[std::size_t(task.sweep)][row_index(lower(task.row, axis))] = task.tile;
  Rings rings(links.size(), axis == 0 ? std::span<const int>() : sizes_.links);
  for (const PassTask& task : order) {
    const auto sweep = std::size_t(task.sweep);
    const auto give = [&] {
      if (has_lower(task)) rings.give(links[sweep][row_index(lower(task.row, axis))]);
    };
    // A row reads what is left for it before it leaves its own in the same place.
    if (!is_filled_) give();
    if (leaves_links(task.work, axis) && upper(task.row, axis) >= 0)
      links[sweep][row_index(task.row)] =
          rings.take(sweep, task.row, reader_tile[sweep][row_index(task.row)] != task.tile);
    if (is_filled_) give();
  }
  links_size_[std::size_t(axis)] = rings.put_in_order(links);
}

} // namespace dss
