#pragma once
/// Sizes of this machine's caches, as the operating system reports them.
#include <cstddef>
#include <unistd.h>

namespace dss {

/// @param name    of sysconf
/// @param common  where the system reports none
inline std::size_t cache_bytes(int name, std::size_t common) {
  const long bytes = ::sysconf(name);
  return bytes > 0 ? std::size_t(bytes) : common;
}
/// L1 of a core [B].
inline std::size_t l1_bytes() { return cache_bytes(_SC_LEVEL1_DCACHE_SIZE, 32u << 10); }
/// L2 of a core [B].
inline std::size_t l2_bytes() { return cache_bytes(_SC_LEVEL2_CACHE_SIZE, 1u << 20); }
/// The last level that cores share [B].
inline std::size_t l3_bytes() { return cache_bytes(_SC_LEVEL3_CACHE_SIZE, 32u << 20); }

} // namespace dss
