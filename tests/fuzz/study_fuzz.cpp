/// Studies: their head and one of their scales. What a kind of study reads then loads scenes of any
/// size, which takes memory and time, so it is left out.
#include "experiments/measure/study_file.hpp"
#include "fuzzed.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dss::answered_for_file(data, size, ".json", [](const std::string& path) {
    dss::open_study(path, "smoke");
    dss::scale_names(path);
  });
}
