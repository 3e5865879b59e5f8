#pragma once
/// Working sets that lie in one level of the memory hierarchy.
#include <cstddef>
#include <string>
#include <vector>

namespace dss {

/// A level of the hierarchy, and how much of it one of `threads` threads works on.
struct WorkingSet {
  std::string level;     ///< L1, L2, L3, memory
  std::size_t bytes = 0; ///< a thread
  std::string unusable;  ///< why there is none here, or empty
};

inline const std::vector<std::string> memory_levels{"L1", "L2", "L3", "memory"};

/// Half of the first levels; of L3 four times L2; twice L3 over all threads, where a quarter of the memory is enough for it.
/// Sizes of caches as the kernel tells them; in virtual machines L3 may be shared with machines that it does not tell of.
WorkingSet working_set(const std::string& level, int threads);

/// The level that holds so many bytes of a thread.
std::string level_of(std::size_t bytes);

} // namespace dss
