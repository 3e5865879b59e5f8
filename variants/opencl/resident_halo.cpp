/// The halo of a part in the resident executor: where its elements lie for the host, and how they
/// are transferred.
#include "variants/engine/packs.hpp"
#include "variants/opencl/resident_executor.hpp"

#include <utility>

namespace dss::opencl {

template <class T, int W>
HaloLayout ResidentExecutor<T, W>::halo_layout(std::span<const std::size_t> elements, int copy) {
  const auto row_at = [&](std::size_t n) { return int(row_of(packed_.lattice, elements[n])); };
  make_images(elements, copy);
  HaloLayout layout;
  for (std::size_t from = 0, to = 0; from < elements.size(); from = to) {
    const int r = row_at(from);
    while (to < elements.size() && row_at(to) == r) ++to;
    add_to_halo(r, elements.subspan(from, to - from), copy, layout);
  }
  // Not stable: images change when rows are fetched, with a shared arena those of all copies.
  return layout;
}

template <class T, int W>
void ResidentExecutor<T, W>::make_images(std::span<const std::size_t> elements, int copy) {
  std::vector<typename HaloRows<T, W>::Row> rows;
  for (const std::size_t element : elements) {
    const int r = int(row_of(packed_.lattice, element));
    const auto [first, twin] = copy_row(copy, r);
    for (T* const numbers : {first, twin})
      if (numbers != nullptr) rows.push_back({numbers, row_size(r)});
  }
  halo_rows_.make_images(std::move(rows));
}

/// Adds the elements of one row to a layout: their places in its image, and the ranges to transfer.
template <class T, int W>
void ResidentExecutor<T, W>::add_to_halo(int r, std::span<const std::size_t> elements, int copy,
                                         HaloLayout& layout) {
  const auto is_own = [&](std::size_t element) { return part_->part.layer[element] == 0; };
  const bool own = is_own(elements.front());
  auto& ranges = (own ? sent_ : received_)[std::size_t(copy)];
  const auto [first, twin] = copy_row(copy, r);
  const auto range_of = [&](T* row, T* from, std::size_t count) {
    return typename HaloRows<T, W>::Range{from, from + count, halo_rows_.image(row) + (from - row)};
  };
  const HaloLayout of_row = rows_.layout(
      elements, [&](int) { return std::pair(first, twin); }, is_own);
  for (const auto& piece : of_row.pieces) {
    T* const at = reinterpret_cast<T*>(piece.at);
    const bool is_twin = twin != nullptr && at >= twin && at < twin + row_size(r);
    const auto range = range_of(is_twin ? twin : first, at, piece.count / sizeof(T));
    HaloRows<T, W>::add(ranges, range);
    layout.pieces.push_back(
        {reinterpret_cast<std::byte*>(range.image), layout.size + piece.offset, piece.count});
  }
  layout.size += of_row.size;
  // A row that has no other writer is transferred whole, which makes fewer transfers.
  const bool is_remote = staged_ ? !packed_.is_computed(r, 0) : blocks_.of(r).is_remote();
  if (T* const whole = own ? (staged_ ? first : twin) : is_remote ? first : nullptr)
    HaloRows<T, W>::add(ranges, range_of(whole, whole, row_size(r)));
}

template <class T, int W>
void ResidentExecutor<T, W>::send_all_sides(int copy) {
  for (const Side side : all_sides) part_->halo.send(side, copy);
}

template <class T, int W>
void ResidentExecutor<T, W>::receive_all_sides(int copy) {
  for (const Side side : all_sides) part_->halo.receive(side, copy);
}

template <class T, int W>
void ResidentExecutor<T, W>::send(int copy) {
  const auto& ranges = sent_[std::size_t(copy)];
  if (is_on_host_) {
    publish_changed();
    halo_rows_.fetch_from_arena(ranges);
  } else {
    problem_.queue.await({halo_rows_.fetch(ranges)});
  }
  send_all_sides(copy);
}

template <class T, int W>
void ResidentExecutor<T, W>::receive(int copy) {
  const auto& ranges = received_[std::size_t(copy)];
  receive_all_sides(copy);
  is_changed_ |= is_on_host_;
  if (is_on_host_)
    halo_rows_.bring_to_arena(ranges);
  else
    halo_rows_.bring(ranges);
}

// What other files call. The other functions are in resident_executor.cpp and resident_steps.cpp.
#define DSS_INSTANTIATE(T, W)                                                                      \
  template HaloLayout ResidentExecutor<T, W>::halo_layout(std::span<const std::size_t>, int);      \
  template void ResidentExecutor<T, W>::send_all_sides(int);                                       \
  template void ResidentExecutor<T, W>::receive_all_sides(int);                                    \
  template void ResidentExecutor<T, W>::send(int);                                                 \
  template void ResidentExecutor<T, W>::receive(int);
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::opencl
