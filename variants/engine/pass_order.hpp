#pragma once
/// The order of the tasks of a pass over rows (DESIGN.md section 4). A pass makes one sweep for
/// each stage of its steps. Sweeps follow one another over the rows, so that a row is used again
/// while it is in the cache.
#include "variants/engine/body_group.hpp"

#include <string>

namespace dss {

/// What a task does: a stage of a row, or only links that the row leaves for upper rows; an extra
/// link; or the sum of a row's extra links, before its stage.
enum class RowWork : std::uint8_t {
  stage,
  upper_links,
  upper_link_y,
  upper_link_z,
  extra_link,
  extra_sum
};

struct PassTask {
  RowWork work;
  std::int16_t sweep;
  int row;  ///< of an extra link: its number
  int tile; ///< counted over all bodies
  bool is_extra() const { return work == RowWork::extra_link || work == RowWork::extra_sum; }
};

/// A tile that holds every row across.
inline constexpr int no_tiles = 0;

/// For the text of a schedule.
std::string tiles_text(int tile);

/// How sweeps go through a body.
struct SweepForm {
  int tile = no_tiles; ///< rows across of a tile
  /// Planes in the order of the rows' numbers: along z, or along y in a body of one layer. Then the
  /// first rows are done first. Else along the longer of y and z, which makes planes small; bodies
  /// with extra links take the direction that suits these.
  bool is_in_row_order = false;
};

/// Orders the tasks of a pass body by body. In a body, sweeps go from plane to plane of rows. Sweep
/// n is n planes behind the first, so a row finds what the sweep before it left in its upper rows,
/// and what its lower rows left for it. Tiles cut the planes: sweep n of tile t has the rows [E_t -
/// n, E_{t+1} - n) across. So nothing is computed twice: the rows that a tile reads of the one
/// before were finished there.
///
/// Bodies that extra links join are swept together, side by side, so that linked rows are few
/// planes apart (body_group.hpp). Each sweep is as many planes behind as the longest extra link and
/// one more. An extra link is computed before the first of its two rows, when both rows are inputs
/// of the sweep and neither is overwritten yet. Such bodies have no tiles.
/// @param sweeps  rows of each sweep, those of a sweep within those of the one before
/// @param extra   of each extra link; its rows are at most as far apart as sweeps differ in rows
std::vector<PassTask> order_pass(const Lattice& lattice, std::span<const SweepRows> sweeps,
                                 SweepForm form, std::span<const LinkedRows> extra = {});

/// Most rows across the sweeps' direction, over all bodies without extra links; 0 if there are
/// none.
int most_rows_across(const Lattice& lattice, SweepRows rows, bool is_in_row_order,
                     std::span<const LinkedRows> extra);

} // namespace dss
