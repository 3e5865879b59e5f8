#pragma once
/// The shape of passes: where blocks begin, steps of a pass, tiles, where rows are cut.
#include "variants/engine/row_storage.hpp"
#include "variants/engine/seams.hpp"

#include <vector>

namespace dss {

/// What is the same for the passes of all blocks.
struct PassShape {
  int steps = 1; ///< steps of a pass
  SweepForm form;
};

/// Cuts the own rows into blocks with about equally much work.
/// @param parts  as many blocks, or one for each row if there are fewer rows
/// @return the first row of each block, then the end of the last
template <class T, int W>
std::vector<int> cut_rows(const PackedRows<T, W>& packed, int parts);

/// How threads divide the own rows: they hand over where they meet. Parts keep the rows in the
/// order of their numbers. The cuts are left to cut_evenly.
template <class T, int W>
RowDivision divide_rows(const PackedRows<T, W>& packed, std::span<const LinkedRows> extra,
                        int threads);
/// Cuts the own rows so that threads have about equally much work in the sweeps of a pass.
template <class T, int W>
void cut_evenly(RowDivision& division, const PackedRows<T, W>& packed, int threads, int sweeps);

/// Steps that a pass computes. Methods in place can let a step follow the one before it, so several
/// steps need only one trip through memory. Up to eight in a plate, else up
/// to four, since the tiles of more steps would be narrow. With several blocks, only so many that
/// sweeps differ by at most half a block, so that blocks wait little for one another.
/// @param blocks  of about equally many rows
/// @param halo    as RowDivision::halo
template <class T, int W>
int steps_a_pass(const PackedRows<T, W>& packed, const Method& method, int blocks, int halo);

/// A plane of a plate is one row, so its rows are cut where those that a pass has in use between
/// its sweeps would leave L2. Rows are not cut if a body has several layers, which tiles divide
/// into rows, or if rows are filled.
/// @param packed  the rows, whole
/// @param asked   as Setup::tile
/// @throws InputError if the tile that was asked for does not fit in the caches
template <class T, int W>
RowCuts choose_cuts(const PackedRows<T, W>& packed, const Method& method, const RowStorage& storage,
                    int asked);

/// Rows across of the tiles of a pass: those asked for, else as many as fit in the caches;
/// no_tiles if that is all.
/// @param steps   of a pass
/// @param across  from most_rows_across
/// @param asked   as Setup::tile
/// @throws InputError if the tile that was asked for does not fit in the caches
template <class T, int W>
int choose_tile(const PackedRows<T, W>& packed, const Method& method, const RowStorage& storage,
                int steps, int across, int asked);

} // namespace dss
