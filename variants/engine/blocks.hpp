#pragma once
/// All blocks of rows of an executor, the remote ones of a part included, and where a row lies in them.
#include "variants/engine/wavefront.hpp"

#include <algorithm>
#include <utility>

namespace dss {

template <class T, int W = simd::lanes<T>>
class Blocks {
public:
  /// @param cuts  first row of each own block, and the end  @param steps  of a pass
  void make(const PackedRows<T, W>& packed, const Method& method, const std::vector<int>& cuts, int fields, int steps) {
    const int rows = int(packed.rows.size()), halo = steps * method.stages * packed.reach;
    if (packed.own_begin > 0) blocks_.emplace_back(packed, 0, packed.own_begin, fields, halo);
    for (std::size_t b = 0; b + 1 < cuts.size(); ++b)
      blocks_.emplace_back(packed, method, cuts[b], cuts[b + 1], fields, halo, steps);
    if (packed.own_end < rows) blocks_.emplace_back(packed, packed.own_end, rows, fields, halo);
  }
  std::vector<Block<T, W>>& all() { return blocks_; }
  const std::vector<Block<T, W>>& all() const { return blocks_; }
  std::size_t first_own() const { return blocks_.front().is_remote() ? 1 : 0; }
  Block<T, W>& of(int r) {
    return *std::find_if(blocks_.begin(), blocks_.end(), [&](const Block<T, W>& block) { return block.owns(r); });
  }
  /// The present state of a row.
  T* row(int r, int parity) {
    Block<T, W>& block = of(r);
    return block.is_remote() ? block.published(r, parity) : block.row(r);
  }
  /// A row of a copy that parts exchange, and where else it is kept (or null).
  std::pair<T*, T*> copy_row(int copy, int r) {
    Block<T, W>& block = of(r);
    T* const published = block.is_published(r) ? block.published(r, copy) : nullptr;
    return {block.is_remote() ? published : block.row(r), block.is_remote() ? nullptr : published};
  }
  void publish_all(int parity) {
    for (Block<T, W>& block : blocks_)
      for (int r = block.begin; r < block.end && !block.is_remote(); ++r)
        if (block.is_published(r)) block.publish(r, parity);
  }

private:
  std::vector<Block<T, W>> blocks_; ///< of a part: remote blocks first and last where it has a halo there
};

} // namespace dss
