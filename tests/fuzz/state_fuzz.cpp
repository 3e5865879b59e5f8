/// Files of states.
#include "experiments/run/state/state_file.hpp"
#include "fuzzed.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dss::answered_for_file(data, size, ".state", [](const std::string& path) {
    dss::read_state_file(path, "dssbench-oracle-1", "is no oracle state");
  });
}
