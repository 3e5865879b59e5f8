#pragma once
/// Where the tasks of a pass keep what they leave for one another: rows of intermediate stages, and
/// links for upper rows.
#include "variants/engine/pass_order.hpp"

#include <algorithm>
#include <array>

namespace dss {

/// Sizes of places [packs], one for each row. Empty: each has one pack.
struct PlaceSizes {
  std::span<const int> stages; ///< for the output of a stage
  std::span<const int> links; ///< for the links that a row leaves across y or z; across x: one pack
};

/// Places of all that a pass keeps. A row has its place from the task that writes it to the last
/// one that reads it. So what one plane leaves for the next stays in the cache, and what a tile
/// leaves for the next one waits as long as it must. Rows that a sweep writes one after the other
/// mostly lie one after the other, as the processor's own prefetching needs it.
class PassPlaces {
public:
  static constexpr int nowhere = -1;
  /// @param sweeps      of a pass
  /// @param of_step     those of a step
  /// @param increments  of each stage, the stages whose outputs the update reads
  /// @param lattice     of all rows; outlives this object
  /// @param rows        the order of rows, in which those of a pass are close; outlives this object
  /// @param extra       rows of the extra links; outlive this object
  /// @param is_filled   rows may be filled. A pack of these reads links that the lower row left for
  ///   several packs, so a row cannot leave its own in their place
  /// @param sizes       outlive this object
  PassPlaces(const Lattice& lattice, const RowOrder& rows, std::span<const PassTask> order,
             int sweeps, StepSweeps of_step, const std::vector<std::vector<int>>& increments,
             std::span<const LinkedRows> extra, bool is_filled, PlaceSizes sizes = {});
  /// Place of the output of a stage of a row [packs]; 0 if no task of the pass writes it.
  int stage_row(int stage, int row) const { return at(stage_rows_, stage, row); }
  /// Place of the links that a row leaves across an axis in a sweep [packs]; 0 if it leaves none.
  int links(int axis, int sweep, int row) const {
    return at(links_[std::size_t(axis)], sweep, row);
  }
  /// What all places take [packs].
  int stage_rows_size() const { return stage_rows_size_; }
  int links_size(int axis) const { return links_size_[std::size_t(axis)]; }

private:
  using Table = std::vector<std::vector<int>>;
  int at(const Table& table, int n, int row) const {
    const int place = row_index(row) < row_count_ ? table[std::size_t(n)][row_index(row)] : nowhere;
    return std::max(0, place);
  }
  Table empty_table(int count) const {
    return Table(std::size_t(count), std::vector<int>(row_count_, nowhere));
  }
  /// Of a row that a task of the pass writes or reads.
  std::size_t row_index(int row) const { return std::size_t(rows_.place(row) - first_); }
  void find_rows(std::span<const PassTask> order);
  void place_stage_rows(std::span<const PassTask> order, StepSweeps of_step,
                        const std::vector<std::vector<int>>& increments);
  void place_links(std::span<const PassTask> order, int axis);
  int upper(int row, int axis) const { return lattice_.rows[std::size_t(row)].upper(axis); }
  int lower(int row, int axis) const { return lattice_.rows[std::size_t(row)].lower(axis); }

  const Lattice& lattice_;
  const RowOrder& rows_;
  const std::span<const LinkedRows> extra_;
  const bool is_filled_;
  const PlaceSizes sizes_;
  int first_ = 0;              ///< place in the order of the tables' first row
  std::size_t row_count_ = 0;  ///< of the tables
  Table stage_rows_;           ///< [stage][row_index]
  std::array<Table, 3> links_; ///< [axis][sweep][row_index]
  int stage_rows_size_ = 0;
  std::array<int, 3> links_size_{};
};

} // namespace dss
