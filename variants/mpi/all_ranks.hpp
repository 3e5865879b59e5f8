#pragma once

namespace dss {

/// In place of the number of a rank: a call waits for all ranks.
inline constexpr int all_ranks = -2;

} // namespace dss
