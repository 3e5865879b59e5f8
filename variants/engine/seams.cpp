#include "variants/engine/seams.hpp"

#include <algorithm>
#include <map>

namespace dss {

SweepRows rows_of_sweep(SweepRows last, int n, int sweeps, int halo, int rows) {
  const int outer = (sweeps - 1 - n) * halo;
  return {std::max(0, last.begin - outer), std::min(rows, last.end + outer)};
}

std::vector<std::vector<SweepRows>> block_sweeps(const RowDivision& division, int rows,
                                                 int sweeps) {
  const std::vector<int>& cuts = division.cuts;
  std::vector<std::vector<SweepRows>> all;
  for (std::size_t b = 0; b + 1 < cuts.size(); ++b) {
    const bool is_first = b == 0, is_last = b + 2 == cuts.size();
    std::vector<SweepRows>& block = all.emplace_back();
    for (int n = 0; n < sweeps; ++n) {
      const auto computed = [&](int begin, int end) {
        return rows_of_sweep({begin, end}, n, sweeps, division.halo, rows);
      };
      const SweepRows whole = computed(cuts.front(), cuts.back());
      const auto between = [&](int cut) {
        return std::clamp(cut + n * division.halo, whole.begin, whole.end);
      };
      if (division.seams == SeamKind::recomputed)
        block.push_back(computed(cuts[b], cuts[b + 1]));
      else
        block.push_back({is_first ? whole.begin : between(cuts[b]),
                         is_last ? whole.end : between(cuts[b + 1])});
    }
  }
  return all;
}

Seams::Seams(const Lattice& lattice, const RowDivision& division,
             std::vector<std::vector<SweepRows>> sweeps, PassReads reads,
             const std::vector<std::vector<PassTask>>& orders)
    : lattice_(lattice), division_(division), sweeps_(std::move(sweeps)), reads_(std::move(reads)),
      blocks_(sweeps_.size()) {
  if (division.seams == SeamKind::recomputed || sweeps_.size() == 1) return;
  is_near_.resize(lattice.rows.size());
  for (std::size_t b = 1; b < sweeps_.size(); ++b) {
    // From what the first row's links to lower rows read, to the upper rows that the block below
    // reads in the last sweep. In a part's outermost sweeps, a block may begin higher than in its
    // last.
    const auto [low, high] =
        std::ranges::minmax(sweeps_[b], {}, [](const SweepRows& rows) { return rows.begin; });
    const int begin = std::max(0, low.begin - division.halo),
              end = std::min(int(is_near_.size()), high.begin + division.halo);
    std::fill(is_near_.begin() + begin, is_near_.begin() + end, true);
  }
  if (reads_.sweeps.stages == 1) find_overwritten(orders);
  hand_over(orders);
  make_waits(orders);
  make_events();
}

void Seams::forget_outputs() {
  for (BlockSeams& block : blocks_) block.places = {};
  overwritten_ = {};
  is_near_ = {};
}

int Seams::owner(int sweep, int row, int reader) const {
  const auto has = [&](int block) {
    return sweeps_[std::size_t(block)][std::size_t(sweep)].has(division_.order.place(row));
  };
  if (division_.seams == SeamKind::recomputed || has(reader)) return reader;
  for (int block = 0; block < int(sweeps_.size()); ++block)
    if (has(block)) return block;
  return reader; // nobody computes it: it lies outside of a part's halo
}

int Seams::handed_over(int block, int output, int row) const {
  const auto& places = blocks_[std::size_t(block)].places;
  if (places.empty() || !is_near(row)) return nowhere;
  const auto found = places.find(key(output, row));
  return found == places.end() ? nowhere : found->second;
}

int Seams::input_of(int block, const PassTask& task, int row) const {
  const StepSweeps& sweeps = reads_.sweeps;
  if (const int stage = sweeps.stage(task.sweep); stage > 0) return stage - 1;
  const int overwriting = sweeps.of_stage(sweeps.stage_of_pass(task.sweep));
  const bool is_kept =
      overwritten_.contains(key(overwriting, row)) && owner(overwriting, row, block) > block;
  return is_kept ? overwriting : state;
}

/// Calls visit(output, row, is_written) for all that a task touches, with `state` for the state.
template <class Visit>
void Seams::each_touch(int block, const PassTask& task, Visit&& visit) const {
  const int stage = reads_.sweeps.stage(task.sweep), stages = reads_.sweeps.stages;
  const auto touch = [&](int output, int row, bool is_written = false) {
    if (is_near(row)) visit(output, row, is_written);
  };
  each_input(lattice_, reads_.extra, task, [&](int row) {
    if (is_near(row)) visit(input_of(block, task, row), row, false);
  });
  if (task.work == RowWork::pressure && is_near(task.row))
    visit(input_of(block, task, task.row), task.row, true);
  if (task.work != RowWork::stage) return;
  touch(state, task.row);
  for (const int m : reads_.increments[std::size_t(stage)]) touch(m, task.row);
  if (stages == 1) touch(int(task.sweep), task.row, true);
  if (stage + 1 < stages)
    touch(stage, task.row, true);
  else
    touch(state, task.row, true);
}

void Seams::find_overwritten(const std::vector<std::vector<PassTask>>& orders) {
  for (const std::vector<PassTask>& order : orders)
    for (const PassTask& task : order)
      if (task.work == RowWork::stage && is_near(task.row))
        overwritten_.insert(key(task.sweep, task.row));
}

void Seams::hand_over(const std::vector<std::vector<PassTask>>& orders) {
  for (int b = 0; b < int(orders.size()); ++b)
    for (const PassTask& task : orders[std::size_t(b)])
      each_touch(b, task, [&](int output, int row, bool) {
        if (output == state) return;
        const int from = owner(writer(output), row, b);
        if (from == b) return;
        BlockSeams& block = blocks_[std::size_t(from)];
        if (!block.places.emplace(key(output, row), block.size).second) return;
        // A pack more lies beyond each row, because rows look one pack ahead.
        block.size += 1 + (reads_.sizes.empty() ? 1 : reads_.sizes[std::size_t(row)]);
      });
}

Seams::Touches Seams::last_touches(const std::vector<std::vector<PassTask>>& orders) const {
  Touches touches;
  for (int b = 0; b < int(orders.size()); ++b)
    for (int n = 0; n < int(orders[std::size_t(b)].size()); ++n)
      each_touch(b, orders[std::size_t(b)][std::size_t(n)], [&](int output, int row, bool writes) {
        std::vector<LastTouch>& of_key = touches[key(output, row)];
        if (of_key.empty() || of_key.back().block != b) of_key.push_back({b, n, -1});
        of_key.back().task = n;
        if (writes) of_key.back().writer = n;
      });
  std::erase_if(touches, [](const auto& touch) { return touch.second.size() < 2; });
  return touches;
}

/// Tasks of a tile wait together, at the first that must: each look at another's progress costs the
/// way between two cores. No circle can arise by that, either, since every wait is for a pass
/// before, or for a higher block in the same pass.
void Seams::make_waits(const std::vector<std::vector<PassTask>>& orders) {
  const Touches touches = last_touches(orders);
  for (int b = 0; b < int(orders.size()); ++b) {
    const std::vector<PassTask>& order = orders[std::size_t(b)];
    std::vector<Wait>& waits = blocks_[std::size_t(b)].waits;
    std::map<std::pair<int, int>, std::size_t> of_tile; ///< [tile, block]
    for (int n = 0; n < int(order.size()); ++n)
      each_touch(b, order[std::size_t(n)], [&](int output, int row, bool writes) {
        const auto found = touches.find(key(output, row));
        if (found == touches.end()) return;
        for (const auto& [block, last, writer] : found->second) {
          const int task = writes ? last : writer;
          if (block == b || task < 0) continue;
          const auto [at, is_new] =
              of_tile.try_emplace({order[std::size_t(n)].tile, block}, waits.size());
          if (is_new) waits.push_back({n, block, block < b, task});
          waits[at->second].event = std::max(waits[at->second].event, task);
        }
      });
  }
}

/// Numbers the tasks that others wait for.
void Seams::make_events() {
  for (const BlockSeams& block : blocks_)
    for (const Wait& wait : block.waits)
      blocks_[std::size_t(wait.block)].events.push_back(wait.event);
  for (BlockSeams& block : blocks_) {
    std::vector<int>& events = block.events;
    std::sort(events.begin(), events.end());
    events.erase(std::unique(events.begin(), events.end()), events.end());
  }
  for (BlockSeams& block : blocks_)
    for (Wait& wait : block.waits) {
      const std::span<const int> events = blocks_[std::size_t(wait.block)].events;
      wait.event =
          1 + int(std::lower_bound(events.begin(), events.end(), wait.event) - events.begin());
    }
}

} // namespace dss
