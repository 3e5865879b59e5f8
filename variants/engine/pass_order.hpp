#pragma once
/// The order of the tasks of a pass over rows (DESIGN.md section 4). A pass makes the sweeps of its
/// steps (step_sweeps.hpp). Sweeps follow one another over the rows, so that a row is used again
/// while it is in the cache.
#include "variants/api/step_sweeps.hpp"
#include "variants/engine/row_order.hpp"

#include <string>

namespace dss {

/// What a task does.
enum class RowWork : std::uint8_t {
  stage,       ///< a stage of a row
  pressure,    ///< the pressures at the input of a stage
  upper_links, ///< only the links that a row leaves for upper rows, or their strains
  upper_link_x,
  upper_link_y,
  upper_link_z,
  extra_link,
  extra_sum ///< the sum of a row's extra links, before its stage
};

/// Whether a task computes a row as a whole, and not only links that it leaves.
constexpr bool computes_row(RowWork work) {
  return work == RowWork::stage || work == RowWork::pressure;
}
/// Whether a task computes the links that a row leaves for its upper row across an axis.
constexpr bool leaves_links(RowWork work, int axis) {
  constexpr RowWork alone[] = {RowWork::upper_link_x, RowWork::upper_link_y, RowWork::upper_link_z};
  return computes_row(work) || work == RowWork::upper_links || work == alone[axis];
}
/// Whether a task reads the links that lower rows left.
constexpr bool reads_links(RowWork work) {
  return computes_row(work) || work == RowWork::upper_links;
}

struct PassTask {
  RowWork work;
  std::int16_t sweep;
  int row;  ///< of an extra link: its number
  int tile; ///< counted over all bodies
  bool is_extra() const { return work == RowWork::extra_link || work == RowWork::extra_sum; }
};

/// Calls visit(row) for each row whose present values a task reads: its own and upper ones, or
/// those of an extra link.
/// @param extra  rows of the extra links
template <class Visit>
void each_input(const Lattice& lattice, std::span<const LinkedRows> extra, const PassTask& task,
                Visit&& visit) {
  if (task.work == RowWork::extra_sum) return;
  if (task.work == RowWork::extra_link) {
    visit(extra[std::size_t(task.row)].i);
    visit(extra[std::size_t(task.row)].j);
    return;
  }
  const Row& row = lattice.rows[std::size_t(task.row)];
  visit(task.row);
  for (const int axis : {0, 1, 2})
    if (row.upper(axis) >= 0 && leaves_links(task.work, axis)) visit(row.upper(axis));
}

/// A tile that holds every row across.
inline constexpr int no_tiles = 0;

/// Where rows are cut, so that tiles can divide them.
struct RowCuts {
  std::vector<int> at; ///< as Lattice::cuts; empty: rows stay whole
  int pieces = 0;      ///< of a tile
};
/// Cuts rows for tiles of about equally many packs. Each sweep of a tile begins a piece before the
/// sweep before it, so between the tiles lie pieces of one pack, one for each sweep but the first.
/// @param first, end  packs of the rows
/// @param width       packs of a tile, at most, if a tile has at least one for each sweep
/// @param lanes       cells of a pack
RowCuts cut_for_tiles(int first, int end, int width, int sweeps, int lanes);

/// For the text of a schedule.
std::string tiles_text(int tile);

/// How sweeps go through a body.
struct SweepForm {
  int tile = no_tiles; ///< rows across of a tile; of cut rows: pieces
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
/// @param rows    the order of which sweeps are ranges
/// @param sweeps  places of the rows of each sweep: those of the one before without a halo (the
/// rows that a sweep
///   needs beside its own), or a halo higher (seams.hpp)
/// @param extra   of each extra link; its rows are at most a halo apart
/// @param of_step  the sweeps of a step
std::vector<PassTask> order_pass(const Lattice& lattice, const RowOrder& rows,
                                 std::span<const SweepRows> sweeps, SweepForm form,
                                 std::span<const LinkedRows> extra = {}, StepSweeps of_step = {});

/// Most rows across the sweeps' direction, over all bodies without extra links; 0 if there are
/// none.
int most_rows_across(const Lattice& lattice, const RowDivision& division, bool is_in_row_order,
                     std::span<const LinkedRows> extra);

} // namespace dss
