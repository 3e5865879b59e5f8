#pragma once
/// Executors with packs of different width write the same elements into a message in different
/// orders. This unit finds the place of each number once, from the layouts of single elements. The
/// receiver can then copy a message in as few pieces as the two orders allow.
#include "variants/api/api.hpp"

#include <algorithm>

namespace dss {

/// Offsets in a message of all stored numbers [bytes]: element by element, and for each element its
/// numbers in their own order.
using MessageOrder = std::vector<std::size_t>;

/// Size of a stored number [bytes].
inline std::size_t number_bytes(Precision precision) {
  return precision == Precision::f64 ? sizeof(double) : sizeof(float);
}

/// Whether some of these executors order a message in their own way.
/// @param lanes  halo_lanes of each
template <class Lanes>
bool are_mixed(const Lanes& lanes) {
  return std::ranges::any_of(
      lanes, [&](const auto& other) { return other == 0 || other != lanes.front(); });
}

/// Finds the order of the numbers of `elements` in a message of this executor.
/// @param elements      ascending local numbers
/// @param copy          copy of the elements, as in Executor::halo_layout
/// @param number_bytes  size of a stored number [bytes]
/// @throws std::logic_error if the layout of one element disagrees with that of all
MessageOrder message_order(Executor& executor, std::span<const std::size_t> elements, int copy,
                           std::size_t number_bytes);

/// The receiver's layout with offsets into the message as the sender writes it.
/// @throws std::logic_error if the two store different amounts of numbers
HaloLayout reordered(const HaloLayout& receiver, const MessageOrder& receiver_order,
                     const MessageOrder& sender_order, std::size_t number_bytes);

} // namespace dss
