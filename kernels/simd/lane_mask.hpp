#pragma once
#include <cstdint>

namespace dss::simd {

/// One bit a lane, lane 0 lowest.
using LaneMask = std::uint16_t;

} // namespace dss::simd
