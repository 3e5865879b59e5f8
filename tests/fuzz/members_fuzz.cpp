/// Members of an ensemble. The first byte chooses the format.
#include "experiments/run/ensemble/members_file.hpp"
#include "fuzzed.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const bool is_json = size > 0 && (data[0] == '{' || data[0] % 2 == 0);
  const auto read = [](const std::string& path) { dss::read_members(path); };
  return is_json ? dss::answered_for_file(data, size, ".json", read)
                 : dss::answered_for_file(data, size, ".csv", read);
}
