#pragma once
/// The order of the tasks of a pass over rows (DESIGN.md section 4). A pass makes one sweep for
/// each stage of its steps. Sweeps follow one another over the rows, so that a row is used again
/// while it is in the cache.
#include "solver/lattice/lattice.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace dss {

/// What a task does with its row: a stage of it, or only links that it leaves for upper rows.
enum class RowWork : std::uint8_t { stage, upper_links, upper_link_y, upper_link_z };

struct PassTask {
  RowWork work;
  std::int16_t sweep;
  int row;
  int tile; ///< counted over all bodies
};

/// Rows [begin, end) that a sweep computes: those of a block, and rows on both sides that later
/// sweeps of the pass read.
struct SweepRows {
  int begin, end;
  bool has(int row) const { return row >= begin && row < end; }
};

/// A tile that holds every row across.
inline constexpr int no_tiles = 0;

/// How sweeps go through a body.
struct SweepForm {
  int tile = no_tiles; ///< rows across of a tile
  /// Planes in the order of the rows' numbers: along z, or along y in a body of one layer. Then the
  /// first rows are done first. Else along the longer of y and z, which makes planes small.
  bool is_by_rows = false;
};

/// Orders the tasks of a pass body by body. In a body, sweeps go from plane to plane of rows. Sweep
/// n is n planes behind the first, so a row finds what the sweep before it left in its upper rows,
/// and what its lower rows left for it. Tiles cut the planes: sweep n of tile t has the rows [E_t -
/// n, E_{t+1} - n) across. So nothing is computed twice: the rows that a tile reads of the one
/// before were finished there.
/// @param sweeps  rows of each sweep, those of a sweep within those of the one before
std::vector<PassTask> order_pass(const Lattice& lattice, std::span<const SweepRows> sweeps,
                                 SweepForm form);

/// Most rows across the sweeps' direction, over all bodies.
int most_rows_across(const Lattice& lattice, SweepRows rows, bool is_by_rows);

} // namespace dss
