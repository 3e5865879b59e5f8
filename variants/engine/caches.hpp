#pragma once
/// The caches of this machine, as schedules need them.
#include <cstddef>

namespace dss {

/// L2 of a core [B].
std::size_t l2_bytes();
/// The last level that cores share [B].
std::size_t l3_bytes();
/// What the rows between the first and the last sweep of a tile may take without slowing down [B]:
/// five times L2, about L2 and a core's share of L3. The knee is not at L2, because the processor
/// foresees rows that follow one another in L3.
std::size_t tile_bytes();

} // namespace dss
