#include "variants/engine/block.hpp"

#include "variants/engine/packs.hpp"

#include <algorithm>

namespace dss {

template <class T, int W>
Block<T, W>::Block(const PackedRows<T, W>& packed, const RowOrder& order, int first, int last,
                   int fields, OuterRows published, OuterRows apart, bool is_remote)
    : begin(first), end(last), packed_(&packed), order_(&order),
      pack_size_(std::size_t(fields) * std::size_t(W)), outer_(published) {
  failures.resize(packed.members().size());
  std::size_t all = 0, outer = 0;
  for (int place = begin; place < end; ++place) {
    const int r = order.row(place);
    offset_.push_back(all);
    published_offset_.push_back(outer);
    all += row_length(r) + (apart.has(place) ? pack_size_ : 0);
    if (is_published(r)) outer += row_length(r);
  }
  // One pack more: rows look one pack ahead.
  if (!is_remote) state_ = Buffer<T>(all + pack_size_, packed.memory);
  for (auto& copy : published_)
    copy = Buffer<T>(outer == 0 ? 0 : outer + pack_size_, packed.memory);
}

template <class T, int W>
void Block<T, W>::publish(int r, int parity) {
  std::copy_n(row(r), row_length(r), published(r, parity));
}

#define DSS_INSTANTIATE(T, W) template class Block<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss
