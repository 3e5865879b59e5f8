#include "variants/api/message_order.hpp"

#include <algorithm>
#include <stdexcept>

namespace dss {
namespace {

constexpr std::size_t unknown = std::size_t(-1);

/// Maps an address in the executor's memory to its offset in the message.
class Addresses {
public:
  explicit Addresses(HaloLayout layout) : pieces_(std::move(layout.pieces)) {
    std::ranges::sort(pieces_, {}, &HaloLayout::Piece::at);
  }
  std::size_t offset_of(const std::byte* at) const {
    const auto behind = std::ranges::upper_bound(pieces_, at, {}, &HaloLayout::Piece::at);
    if (behind == pieces_.begin() || at >= (behind - 1)->at + (behind - 1)->count)
      throw std::logic_error("halo: an element lies elsewhere alone than among others");
    return (behind - 1)->offset + std::size_t(at - (behind - 1)->at);
  }

private:
  std::vector<HaloLayout::Piece> pieces_;
};

void append(HaloLayout& layout, const HaloLayout::Piece& piece) {
  if (!layout.pieces.empty()) {
    HaloLayout::Piece& last = layout.pieces.back();
    if (last.at + last.count == piece.at && last.offset + last.count == piece.offset) {
      last.count += piece.count;
      return;
    }
  }
  layout.pieces.push_back(piece);
}

} // namespace

MessageOrder message_order(Executor& executor, std::span<const std::size_t> elements, int copy,
                           std::size_t number_bytes) {
  const Addresses addresses(halo_layout(executor, elements, copy));
  MessageOrder order;
  for (const std::size_t element : elements) {
    const HaloLayout single = halo_layout(executor, {&element, 1}, copy);
    const std::size_t first = order.size();
    order.resize(first + single.size / number_bytes, unknown);
    for (const HaloLayout::Piece& piece : single.pieces)
      for (std::size_t byte = 0; byte < piece.count; byte += number_bytes)
        if (std::size_t& offset = order[first + (piece.offset + byte) / number_bytes];
            offset == unknown)
          offset = addresses.offset_of(piece.at + byte);
  }
  return order;
}

HaloLayout reordered(const HaloLayout& receiver, const MessageOrder& receiver_order,
                     const MessageOrder& sender_order, std::size_t number_bytes) {
  if (receiver_order.size() != sender_order.size() ||
      receiver.size != receiver_order.size() * number_bytes)
    throw std::logic_error("halo: two members do not store the same numbers of an element");
  std::vector<std::size_t> sender_offset(receiver_order.size());
  for (std::size_t n = 0; n < receiver_order.size(); ++n)
    sender_offset[receiver_order[n] / number_bytes] = sender_order[n];
  HaloLayout layout{{}, receiver.size, receiver.is_stable};
  for (const HaloLayout::Piece& piece : receiver.pieces)
    for (std::size_t byte = 0; byte < piece.count; byte += number_bytes)
      append(layout,
             {piece.at + byte, sender_offset[(piece.offset + byte) / number_bytes], number_bytes});
  return layout;
}

} // namespace dss
