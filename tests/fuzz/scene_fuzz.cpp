/// Whole scenes. Large ones are left out, because they take memory: by their cells, and by their
/// text, since the lines of a voxel mask may promise as many cells as their lengths multiplied.
#include "fuzzed.hpp"
#include "solver/scene/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr double most_cells = 5000;
  constexpr std::size_t most_text = 5000;
  if (size > most_text) return 0;
  return dss::answered_for_file(data, size, ".json", [](const std::string& path) {
    if (dss::scene_size(path).cells <= most_cells) dss::load_scene(path);
  });
}
