#pragma once
/// Where the tasks of a pass keep what they leave for one another: rows of intermediate stages, and
/// links for upper rows.
#include "variants/engine/pass_order.hpp"

#include <algorithm>
#include <array>

namespace dss {

/// Places of all that a pass keeps. A row has its place from the task that writes it to the last
/// one that reads it. So what one plane leaves for the next stays in the cache, and what a tile
/// leaves for the next one waits as long as it must. Rows that a sweep writes one after the other
/// mostly lie one after the other, as the processor's own prefetching needs it.
class PassPlaces {
public:
  static constexpr int nowhere = -1;
  /// @param stages      stages of a step; sweep n computes stage n % stages
  /// @param increments  of each stage, the stages whose outputs the update reads
  /// @param lattice     of all rows; outlives this object
  PassPlaces(const Lattice& lattice, std::span<const PassTask> order, int sweeps, int stages,
             const std::vector<std::vector<int>>& increments);
  /// Place of the output of a stage of a row; 0 if no task of the pass writes it.
  int stage_row(int stage, int row) const { return at(stage_rows_, stage, row); }
  /// Place of the links that a row leaves across axis 1 (y) or 2 (z) in a sweep; 0 if it leaves
  /// none.
  int links(int axis, int sweep, int row) const {
    return at(links_[std::size_t(axis) - 1], sweep, row);
  }
  int stage_row_count() const { return stage_row_count_; }
  int links_count(int axis) const { return links_count_[std::size_t(axis) - 1]; }

private:
  using Table = std::vector<std::vector<int>>;
  static int at(const Table& table, int n, int row) {
    return std::max(0, table[std::size_t(n)][std::size_t(row)]);
  }
  void place_stage_rows(std::span<const PassTask> order, int stages,
                        const std::vector<std::vector<int>>& increments);
  void place_links(std::span<const PassTask> order, int axis);
  int upper(int row, int axis) const {
    const Row& r = lattice_.rows[std::size_t(row)];
    return axis == 1 ? r.upper_y : r.upper_z;
  }
  int lower(int row, int axis) const {
    const Row& r = lattice_.rows[std::size_t(row)];
    return axis == 1 ? r.lower_y : r.lower_z;
  }

  const Lattice& lattice_;
  Table stage_rows_;           ///< [stage][row]
  std::array<Table, 2> links_; ///< [axis - 1][sweep][row]
  int stage_row_count_ = 0;
  std::array<int, 2> links_count_{};
};

} // namespace dss
