#include "variants/engine/caches.hpp"

#include <unistd.h>

namespace dss {

std::size_t l2_bytes() {
  const long bytes = ::sysconf(_SC_LEVEL2_CACHE_SIZE); // 0 or -1 where it is not known
  return bytes > 0 ? std::size_t(bytes) : std::size_t(1) << 20;
}

std::size_t l3_bytes() {
  const long bytes = ::sysconf(_SC_LEVEL3_CACHE_SIZE);
  return bytes > 0 ? std::size_t(bytes) : 32 * l2_bytes();
}

std::size_t tile_bytes() { return 5 * l2_bytes(); }

} // namespace dss
