#pragma once
/// The state of a contiguous block of rows, and what other blocks read of it.
#include "variants/engine/packed_rows.hpp"

#include <array>
#include <vector>

namespace dss {

/// A contiguous block of rows with its own storage. The rows that other blocks read are published
/// in two copies, one for each parity of the pass. So one synchronisation a pass is enough: pass n
/// reads one copy and writes the other for pass n + 1. The halo rows of a part before or behind its
/// own rows are a remote block: messages publish it, another part computes it.
template <class T, int W = simd::lanes<T>>
class Block {
public:
  /// @param fields  numbers that a pack holds for each element
  /// @param halo    rows that other blocks read of this one, and this one of them
  /// @param steps   steps of a pass; if more than one, the block also stores copies of the halo's
  ///   rows and steps them
  Block(const PackedRows<T, W>& packed, int begin, int end, int fields, int halo, int steps);
  /// Makes a remote block.
  Block(const PackedRows<T, W>& packed, int begin, int end, int fields, int halo);

  int begin, end;
  int stored_begin, stored_end; ///< rows that are stored here: own rows, and copies of the halo's
  bool is_remote() const { return state_.empty(); }
  T* row(int r) {
    return state_.data() + (packed_->rows[std::size_t(r)].pack_offset -
                            packed_->rows[std::size_t(stored_begin)].pack_offset) *
                               pack_size_;
  }
  /// Length of a row [numbers].
  std::size_t row_length(int r) const {
    return std::size_t(packed_->rows[std::size_t(r)].packs) * pack_size_;
  }
  bool owns(int r) const { return r >= begin && r < end; }
  bool is_published(int r) const {
    return (r < begin + halo_ && begin > 0) ||
           (r >= end - halo_ && end < int(packed_->rows.size()));
  }
  T* published(int r, int parity) {
    return published_[std::size_t(parity)].data() + published_offset_[std::size_t(r - begin)];
  }
  void publish(int r, int parity);
  /// The first failure of a member (of a problem alone: the only one) in a pass.
  struct Failure {
    int step = -1; ///< counted from the first of the pass; -1: none
    std::size_t element = 0;
    void meet(int at_step, std::size_t at_element) {
      if (step < 0 || at_step < step || (at_step == step && at_element < element))
        *this = {at_step, at_element};
    }
  };
  std::vector<Failure> failures; ///< of each member
  std::size_t bytes() const {
    return state_.bytes() + published_[0].bytes() + published_[1].bytes();
  }

private:
  void make_published();
  const PackedRows<T, W>* packed_;
  std::size_t pack_size_;
  int halo_;
  Buffer<T> state_;
  std::array<Buffer<T>, 2> published_;
  /// Published rows follow one another without gaps, so that neighbouring rows make one message.
  std::vector<std::size_t> published_offset_;
};

} // namespace dss
