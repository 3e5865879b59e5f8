#pragma once
/// Structs of numbers beside the same structs of a number of each lane.
#include "kernels/stage_row/row.hpp"

#include <cstddef>
#include <cstring>

namespace dss {

/// Sets a lane of `count` numbers of each lane. Both structs begin with these numbers, in the same
/// order.
template <class T, class OfLanes, class One>
void set_lane(OfLanes& all, std::size_t lane, const One& one, std::size_t count) {
  const auto* const from = reinterpret_cast<const std::byte*>(&one);
  auto* const to = reinterpret_cast<std::byte*>(&all);
  for (std::size_t n = 0; n < count; ++n)
    std::memcpy(to + n * sizeof(LaneNumbers<T>) + lane * sizeof(T), from + n * sizeof(T),
                sizeof(T));
}

} // namespace dss
