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
  /// Makes all blocks.
  /// @param cuts    first row of each own block, then the end of the last
  /// @param fields  numbers that a pack holds for each element
  /// @param steps   steps of a pass
  /// @param stages  of a step
  void make(const PackedRows<T, W>& packed, const std::vector<int>& cuts, int fields, int steps,
            int stages) {
    const int rows = int(packed.rows.size()), halo = steps * stages * packed.stage_halo;
    if (packed.own_begin > 0) blocks_.emplace_back(packed, 0, packed.own_begin, fields, halo);
    for (std::size_t b = 0; b + 1 < cuts.size(); ++b)
      blocks_.emplace_back(packed, cuts[b], cuts[b + 1], fields, halo, steps);
    if (packed.own_end < rows) blocks_.emplace_back(packed, packed.own_end, rows, fields, halo);
  }
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
      for (int r = block.begin; r < block.end && !block.is_remote(); ++r)
        if (block.is_published(r)) block.publish(r, parity);
  }

private:
  /// A part's halo rows before and behind its own rows are remote blocks, first and last.
  std::vector<Block<T, W>> blocks_;
};

} // namespace dss
