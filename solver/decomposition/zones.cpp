#include "solver/decomposition/zones.hpp"

#include <map>
#include <tuple>

namespace dss {
namespace {

CellSet own_cells(const CellGrid& grid, const Decomposition& decomposition, int index) {
  CellSet cells;
  for (const Share& share : decomposition.shares)
    if (share.part == index) cells.append(share.segment);
  return grid.present(cells);
}

/// Splits a set into pieces by the part that owns them.
void sort_by_owner(const CellSet& set, const Decomposition& decomposition,
                   std::map<int, std::vector<Segment>>& pieces) {
  const std::vector<Share>& shares = decomposition.shares;
  for (const Segment& wanted : set.segments()) {
    auto share = std::upper_bound(
        shares.begin(), shares.end(), wanted, [](const Segment& piece, const Share& s) {
          return std::tie(piece.row, piece.x_begin) < std::tie(s.segment.row, s.segment.x_end);
        });
    for (; share != shares.end() && share->segment.row == wanted.row &&
           share->segment.x_begin < wanted.x_end;
         ++share)
      pieces[share->part].push_back({wanted.row, std::max(wanted.x_begin, share->segment.x_begin),
                                     std::min(wanted.x_end, share->segment.x_end)});
  }
}

void append_run(std::vector<Run>& runs, const Run& run) {
  if (!runs.empty() && runs.back().local + runs.back().count == run.local &&
      runs.back().global + runs.back().count == run.global)
    runs.back().count += run.count;
  else
    runs.push_back(run);
}

} // namespace

// All elements of another part within `depth` of this part are in this part's halo. The distance is
// symmetric, so what this part sends is what the other part receives.
Zones find_zones(const CellGrid& grid, const Decomposition& decomposition, int index, int depth) {
  Zones zones;
  zones.own = own_cells(grid, decomposition, index);
  CellSet reached = zones.own;
  std::map<int, std::vector<Segment>> halo;
  for (int k = 0; k < depth; ++k) {
    CellSet wider = grid.dilated(reached);
    zones.layers.push_back(grid.present(difference(wider, reached)));
    sort_by_owner(zones.layers.back(), decomposition, halo);
    reached = std::move(wider);
  }
  zones.all = grid.present(reached);
  for (auto& [part, pieces] : halo) {
    Zones::Face face{part, {}, CellSet(std::move(pieces))};
    CellSet near = face.receive;
    for (int k = 0; k < depth; ++k) near = grid.dilated(near);
    face.send = intersection(near, zones.own);
    zones.faces.push_back(std::move(face));
  }
  return zones;
}

Addresses::Addresses(const CellGrid& grid, const CellSet& set) {
  std::size_t local = 0;
  grid.for_each_run(set, [&](const Segment& run, std::size_t first) {
    const auto count = std::size_t(run.x_end - run.x_begin);
    append_run(runs_, {local, first, count});
    local += count;
  });
}

std::optional<std::size_t> Addresses::local(std::size_t global) const {
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), global,
                                      [](std::size_t e, const Run& run) { return e < run.global; });
  if (after == runs_.begin()) return {};
  const Run& run = *(after - 1);
  if (global - run.global >= run.count) return {};
  return run.local + (global - run.global);
}

std::vector<Run> Addresses::runs_of(const CellGrid& grid, const CellSet& subset) const {
  std::vector<Run> runs;
  grid.for_each_run(subset, [&](const Segment& run, std::size_t first) {
    append_run(runs, {*local(first), first, std::size_t(run.x_end - run.x_begin)});
  });
  return runs;
}

} // namespace dss
