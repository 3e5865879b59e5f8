/// Decomposition files, of a plate of 6 x 6 elements.
#include "fuzzed.hpp"
#include "solver/decomposition/decomposition_file.hpp"
#include "solver/scene/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const dss::Scene scene = dss::load_scene("plate_paper", {{"n", "6"}});
  return dss::answered_for_file(data, size, ".json", [](const std::string& path) {
    dss::read_decomposition(path, scene.problem);
  });
}
