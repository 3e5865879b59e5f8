#pragma once
/// Work of studies that is not timed, on all cores.
#include <cstddef>
#include <functional>

namespace dss {

/// Calls work(0) ... work(count - 1), each once, in any order and several at once. Threads end with the call, so that
/// none of them spins beside what is timed next.
/// @throws what the first failing call threw, when those under way have ended; later ones are not begun
void for_each_on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work);

} // namespace dss
