/// Platform files, as far as this program reads them; the rest is SimGrid's.
#include "experiments/run/cluster/simulation.hpp"
#include "fuzzed.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dss::answered_for_file(data, size, ".xml", dss::Platform::require_known);
}
