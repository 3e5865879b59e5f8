#include "variants/engine/block.hpp"

#include "variants/engine/packs.hpp"

#include <algorithm>

namespace dss {

template <class T, int W>
Block<T, W>::Block(const PackedRows<T, W>& packed, int first, int last, int fields, int halo,
                   int steps)
    : begin(first), end(last), stored_begin(steps == 1 ? begin : std::max(0, begin - halo)),
      stored_end(steps == 1 ? end : std::min(int(packed.rows.size()), end + halo)),
      packed_(&packed), pack_size_(std::size_t(fields) * std::size_t(W)), halo_(halo) {
  // One pack more: rows look one pack ahead.
  state_ = Buffer<T>((packed.packs_of(stored_begin, stored_end) + 1) * pack_size_, packed.memory);
  failures.resize(packed.members().size());
  make_published();
}

template <class T, int W>
Block<T, W>::Block(const PackedRows<T, W>& packed, int first, int last, int fields, int halo)
    : begin(first), end(last), stored_begin(first), stored_end(first), packed_(&packed),
      pack_size_(std::size_t(fields) * std::size_t(W)), halo_(halo) {
  make_published();
}

template <class T, int W>
void Block<T, W>::make_published() {
  std::size_t packs = 0;
  for (int r = begin; r < end; ++r) {
    published_offset_.push_back(packs * pack_size_);
    if (is_published(r)) packs += std::size_t(packed_->rows[std::size_t(r)].packs);
  }
  for (auto& copy : published_)
    copy = Buffer<T>(packs == 0 ? 0 : (packs + 1) * pack_size_, packed_->memory);
}

template <class T, int W>
void Block<T, W>::publish(int r, int parity) {
  std::copy_n(row(r), row_length(r), published(r, parity));
}

#define DSS_INSTANTIATE(T, W) template class Block<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
