#pragma once
/// Working sets that fit in one level of the memory hierarchy.
#include <cstddef>
#include <string>
#include <vector>

namespace dss {

/// A level of the hierarchy and the bytes of it that each thread works on.
struct WorkingSet {
  std::string level;     ///< L1, L2, L3, memory
  std::size_t bytes = 0; ///< per thread
  std::string unusable;  ///< reason why there is none here, or empty
};

/// Names of the levels, from the core outwards.
inline const std::vector<std::string> memory_levels{"L1", "L2", "L3", "memory"};

/// Working set of each of `threads` threads.
/// L1 and L2: half of the cache. L3: four times the L2 cache. Memory: twice the L3 cache, divided
/// by the threads, if that is at most a quarter of the memory.
/// Cache sizes are those that the operating system reports. In a virtual machine, other machines
/// may use the same L3.
WorkingSet working_set(const std::string& level, int threads);

/// The level that holds this number of bytes of a thread.
std::string level_of(std::size_t bytes);

} // namespace dss
