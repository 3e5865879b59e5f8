#include "solver/cores.hpp"

#include <sched.h>

namespace dss {

std::vector<int> affinity() {
  std::vector<int> cores;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return cores;
  for (int core = 0; core < CPU_SETSIZE; ++core)
    if (CPU_ISSET(core, &set)) cores.push_back(core);
  return cores;
}

int usable_cores() {
  const std::size_t cores = affinity().size();
  return cores == 0 ? 1 : int(cores);
}

} // namespace dss
