#include "variants/engine/pass_shape.hpp"

#include "solver/error.hpp"
#include "variants/api/cache_sizes.hpp"
#include "variants/engine/packs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {

/// @param halo  each sweep has the blocks' rows so much higher than the one before
template <class T, int W>
static std::vector<int> even_cuts(const PackedRows<T, W>& packed, const RowOrder& order, int parts,
                                  int sweeps, int halo) {
  const int begin = packed.own_begin, end = packed.own_end, rows = int(packed.rows.size());
  parts = std::clamp(parts, 1, end - begin);
  std::vector<std::size_t> packs{0}; // before each place
  for (int place = 0; place < rows; ++place)
    packs.push_back(packs.back() + std::size_t(packed.rows[std::size_t(order.row(place))].packs));
  const auto work_before = [&](int place) {
    std::size_t work = 0;
    for (int n = 0; n < sweeps; ++n) {
      const SweepRows all = rows_of_sweep({begin, end}, n, sweeps, halo, rows);
      work += packs[std::size_t(std::clamp(place + n * halo, all.begin, all.end))] -
              packs[std::size_t(all.begin)];
    }
    return work;
  };
  const std::size_t all = work_before(rows);
  std::vector<int> cuts{begin};
  for (int p = 1; p < parts; ++p) {
    const std::size_t target = all * std::size_t(p) / std::size_t(parts);
    int place = cuts.back() + 1; // every block has a row
    while (place < end - (parts - p) && work_before(place) < target) ++place;
    cuts.push_back(place);
  }
  cuts.push_back(end);
  return cuts;
}

template <class T, int W>
std::vector<int> cut_rows(const PackedRows<T, W>& packed, int parts) {
  return even_cuts(packed, {}, parts, 1, 0);
}

template <class T, int W>
RowDivision divide_rows(const PackedRows<T, W>& packed, std::span<const LinkedRows> extra,
                        int threads) {
  RowDivision division;
  division.seams = SeamKind::handed_over;
  if (threads > 1 && !packed.is_part()) division.order = RowOrder(packed.lattice, extra);
  division.halo = division.order.halo(packed.lattice, extra);
  return division;
}

template <class T, int W>
void cut_evenly(RowDivision& division, const PackedRows<T, W>& packed, int threads, int sweeps) {
  division.cuts = even_cuts(packed, division.order, threads, sweeps, division.halo);
}

template <class T, int W>
int steps_a_pass(const PackedRows<T, W>& packed, const Method& method, int blocks, int halo) {
  if (!method.is_in_place() || packed.is_part()) return 1;
  int steps = packed.reach <= 1 || packed.is_cut() ? 8 : 4;
  const int sweeps = packed.sweeps(method).count();
  const int rows = int(packed.rows.size()) / blocks;
  while (steps > 1 && blocks > 1 && 2 * steps * sweeps * halo > rows) --steps;
  return steps;
}

/// The last stage that reads the output of stage s.
static int last_reader(const Method& method, int s) {
  for (int reader = method.stages - 1; reader > s + 1; --reader)
    if (method.alpha[std::size_t(reader)][std::size_t(s) + 1] != 0) return reader;
  return s + 1;
}

/// What the rows between the first and the last sweep of a tile should take at most [B]. Two kinds
/// of processors were measured (README.md). Beside an L2 of 1 MB (Zen 4) the L3 is fast, and tiles
/// may take about L2 and a core's share of L3: narrower ones pay more for their seams than they
/// gain. Beside an L2 of 2 MB (server cores of Intel since Sapphire Rapids) the L3 is slow, and
/// tiles should leave a third of L2 free.
static std::size_t tile_bytes() {
  constexpr std::size_t large_l2 = 2u << 20;
  return l2_bytes() >= large_l2 ? l2_bytes() * 2 / 3 : 5 * l2_bytes();
}

/// What the rows between the first and the last sweep take of a row across [B].
template <class T, int W>
static double bytes_across(const PackedRows<T, W>& packed, const Method& method,
                           const RowStorage& storage, int steps) {
  // Planes of rows between the first and the last touch of a row: of the state and of the links one
  // for each sweep, of the output of a stage those up to its last reader.
  const int sweeps = steps * packed.sweeps(method).count();
  double planes = sweeps * (1 + double(packed.carry_size) / (storage.stored() * W));
  for (int stage = 0; stage + 1 < method.stages; ++stage)
    planes += (last_reader(method, stage) - stage) * packed.sweeps(method).a_stage();
  return planes * double(packed.tiled_packs) * storage.stored() * W * sizeof(T);
}

/// @param bytes  of a row or an element across
/// @throws InputError if a tile of so many does not fit in the caches
static void require_cached(int asked, double bytes) {
  if (const int most = std::max(1, int(double(l3_bytes()) / bytes)); asked > most)
    throw InputError(fmt::format(
        "--tile {}: between its sweeps, {:.0f} MB of rows would leave the caches; give at most {}",
        asked, 1e-6 * asked * bytes, most));
}

template <class T, int W>
RowCuts choose_cuts(const PackedRows<T, W>& packed, const Method& method, const RowStorage& storage,
                    int asked) {
  if (packed.filled.is_any() || packed.is_ensemble()) return {};
  RowDivision whole;
  whole.cuts = {0, int(packed.rows.size())};
  if (most_rows_across(packed.lattice, whole, packed.is_part(), {}) > 1) return {};
  int first = packed.packs_across, end = 0;
  for (const PackedRow<T>& row : packed.rows)
    first = std::min(first, row.first_pack), end = std::max(end, row.first_pack + row.packs);
  const int steps = steps_a_pass(packed, method, 1, 1);
  const double pack_bytes = bytes_across(packed, method, storage, steps) / packed.tiled_packs;
  if (asked < (end - first) * W) require_cached(asked, pack_bytes / W);
  // The border between two tiles costs more than the one between rows of a solid (README.md).
  constexpr double share = 2.0 / 3;
  const int width =
      asked > 0 ? (asked + W - 1) / W : int(share * double(tile_bytes()) / pack_bytes);
  return cut_for_tiles(first, end, width, steps * packed.sweeps(method).count(), W);
}

template <class T, int W>
int choose_tile(const PackedRows<T, W>& packed, const Method& method, const RowStorage& storage,
                int steps, int across, int asked) {
  const double across_bytes = bytes_across(packed, method, storage, steps);
  if (asked >= across || across <= 1) return no_tiles;
  require_cached(asked, across_bytes);
  if (asked > 0) return asked;
  const double fit = double(tile_bytes()) / across_bytes;
  if (across <= fit) return no_tiles;
  const int tiles = int(std::ceil(across / std::max(fit, 1.0)));
  return (across + tiles - 1) / tiles;
}

#define DSS_INSTANTIATE(T, W)                                                                      \
  template std::vector<int> cut_rows(const PackedRows<T, W>&, int);                                \
  template RowDivision divide_rows(const PackedRows<T, W>&, std::span<const LinkedRows>, int);     \
  template void cut_evenly(RowDivision&, const PackedRows<T, W>&, int, int);                       \
  template int steps_a_pass(const PackedRows<T, W>&, const Method&, int, int);                     \
  template RowCuts choose_cuts(const PackedRows<T, W>&, const Method&, const RowStorage&, int);    \
  template int choose_tile(const PackedRows<T, W>&, const Method&, const RowStorage&, int, int,    \
                           int);
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
