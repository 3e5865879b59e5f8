/// JSON, and scenes up to their parameters.
#include "fuzzed.hpp"
#include "solver/scene/scene_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dss::answered_for_file(data, size, ".json", [](const std::string& path) {
    dss::read_scene_text(path, {{"run.dt", "1e-7"}});
  });
}
