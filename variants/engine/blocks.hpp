#pragma once
/// All blocks of rows of an executor, including the remote blocks of a part, and the places of rows
/// in them.
#include "variants/engine/block.hpp"

#include <algorithm>
#include <utility>

namespace dss {

template <class T, int W = simd::lanes<T>>
class Blocks {
public:
  /// Makes all blocks. Where they recompute their seams, each publishes its outer rows; where they
  /// hand over, only a part does.
  /// @param division  outlives this object
  /// @param fields    numbers that a pack holds for each element
  /// @param sweeps    of a pass
  void make(const PackedRows<T, W>& packed, const RowDivision& division, int fields, int sweeps) {
    division_ = &division;
    const int rows = int(packed.rows.size()), halo = sweeps * division.halo;
    const auto outer = [&](int begin, int end) {
      OuterRows outer_rows;
      if (begin > 0) outer_rows.below = begin + halo;
      if (end < rows) outer_rows.from = end - halo;
      return outer_rows;
    };
    const bool is_recomputed = division.seams == SeamKind::recomputed;
    const auto add = [&](int begin, int end, OuterRows published, bool is_remote) {
      OuterRows apart;
      if (!is_recomputed && division.blocks() > 1) apart = {begin + halo, end - division.halo};
      blocks_.emplace_back(packed, division.order, begin, end, fields, published, apart, is_remote);
    };
    const std::vector<int>& cuts = division.cuts;
    const int first = cuts.front(), last = cuts.back();
    if (first > 0) add(0, first, outer(0, first), true);
    for (std::size_t b = 0; b + 1 < cuts.size(); ++b)
      add(cuts[b], cuts[b + 1], is_recomputed ? outer(cuts[b], cuts[b + 1]) : outer(first, last),
          false);
    if (last < rows) add(last, rows, outer(last, rows), true);
  }
  const RowDivision& division() const { return *division_; }
  std::vector<Block<T, W>>& all() { return blocks_; }
  const std::vector<Block<T, W>>& all() const { return blocks_; }
  std::size_t first_own() const { return blocks_.front().is_remote() ? 1 : 0; }
  Block<T, W>& of(int r) {
    return *std::find_if(blocks_.begin(), blocks_.end(),
                         [&](const Block<T, W>& block) { return block.owns(r); });
  }
  /// The present state of a row.
  /// @param parity  which published copy is the present one
  T* row(int r, int parity) {
    Block<T, W>& block = of(r);
    return block.is_remote() ? block.published(r, parity) : block.row(r);
  }
  /// Two places of a row of a copy that parts exchange: where it is kept, and its other place or
  /// null.
  std::pair<T*, T*> copy_row(int copy, int r) {
    Block<T, W>& block = of(r);
    T* const published = block.is_published(r) ? block.published(r, copy) : nullptr;
    return {block.is_remote() ? published : block.row(r), block.is_remote() ? nullptr : published};
  }
  /// Publishes the rows that other blocks read, in the copy of this parity.
  void publish_all(int parity) {
    for (Block<T, W>& block : blocks_)
      for (int place = block.begin; place < block.end && !block.is_remote(); ++place)
        if (const int r = division_->order.row(place); block.is_published(r))
          block.publish(r, parity);
  }

private:
  const RowDivision* division_ = nullptr;
  /// A part's halo rows before and behind its own rows are remote blocks, first and last.
  std::vector<Block<T, W>> blocks_;
};

} // namespace dss
