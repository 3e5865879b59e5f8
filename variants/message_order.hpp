#pragma once
/// Executors whose elements lie together in other numbers order a message differently. What stands where is found once, from the layouts
/// of single elements, so that messages are copied in as few pieces as the two orders allow.
#include "variants/api.hpp"

namespace dss {

/// Where in a message each stored number lies [bytes]: element after element, in each its numbers in their own order.
using MessageOrder = std::vector<std::size_t>;

/// Size of a stored number.
inline std::size_t number_bytes(Precision precision) {
  return precision == Precision::f64 ? sizeof(double) : sizeof(float);
}

/// @param number_bytes  size of a stored number
MessageOrder message_order(Executor& executor, std::span<const std::size_t> elements, int copy,
                           std::size_t number_bytes);

/// A receiver's layout, with offsets into the message as the sender orders it. @throws std::logic_error if one has more numbers
HaloLayout reordered(const HaloLayout& receiver, const MessageOrder& receiver_order, const MessageOrder& sender_order,
                     std::size_t number_bytes);

} // namespace dss
