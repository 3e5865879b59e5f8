#pragma once
/// The state of a contiguous block of rows, and what other blocks read of it.
#include "variants/engine/packed_rows.hpp"
#include "variants/engine/row_order.hpp"

#include <array>
#include <limits>
#include <vector>

namespace dss {

/// Places below one and from another one on.
struct OuterRows {
  int below = 0, from = std::numeric_limits<int>::max();
  bool has(int place) const { return place < below || place >= from; }
};

/// A block of rows, which follow one another in a RowOrder, with its own storage. Rows can be
/// published in two copies, one for each parity of the pass: those that parts exchange, and where
/// blocks recompute their seams those that other blocks read. So one synchronisation a pass is
/// enough: pass n reads one copy and writes the other for pass n + 1. The halo rows of a part
/// before or behind its own rows are a remote block: messages publish it, another part computes it.
template <class T, int W = simd::lanes<T>>
class Block {
public:
  /// @param order       outlives the block
  /// @param begin, end  places
  /// @param fields      numbers that a pack holds for each element
  /// @param published   rows that are published
  /// @param is_remote   another part computes the rows, so only published ones are stored
  /// @param apart       rows that other threads touch; one pack more lies beyond each, because rows
  ///   look one pack ahead
  Block(const PackedRows<T, W>& packed, const RowOrder& order, int begin, int end, int fields,
        OuterRows published, OuterRows apart, bool is_remote);

  int begin, end; ///< places
  bool is_remote() const { return state_.empty(); }
  T* row(int r) { return state_.data() + offset_[index(r)]; }
  /// Length of a row [numbers].
  std::size_t row_length(int r) const {
    return std::size_t(packed_->rows[std::size_t(r)].packs) * pack_size_;
  }
  bool owns(int r) const { return order_->place(r) >= begin && order_->place(r) < end; }
  bool is_published(int r) const { return outer_.has(order_->place(r)); }
  T* published(int r, int parity) {
    return published_[std::size_t(parity)].data() + published_offset_[index(r)];
  }
  void publish(int r, int parity);
  /// The first failure of a member (of a problem alone: the only one) that the block met in a pass.
  struct Failure {
    int step = -1; ///< counted from the first of the pass; -1: none
    std::size_t element = 0;
    void meet(int at_step, std::size_t at_element) {
      if (step < 0 || at_step < step || (at_step == step && at_element < element))
        *this = {at_step, at_element};
    }
  };
  std::vector<Failure> failures; ///< of each member
  std::size_t state_bytes() const { return state_.bytes(); }
  std::size_t bytes() const {
    return state_.bytes() + published_[0].bytes() + published_[1].bytes();
  }

private:
  std::size_t index(int r) const { return std::size_t(order_->place(r) - begin); }
  const PackedRows<T, W>* packed_;
  const RowOrder* order_;
  std::size_t pack_size_;
  OuterRows outer_;                 ///< published
  std::vector<std::size_t> offset_; ///< of each row in `state_`
  Buffer<T> state_;
  std::array<Buffer<T>, 2> published_;
  /// Published rows follow one another without gaps, so that neighbouring rows make one message. A
  /// row that looks one pack ahead may read the next one's pressure while another thread stores it;
  /// no link reads these lanes.
  std::vector<std::size_t> published_offset_;
};

} // namespace dss
