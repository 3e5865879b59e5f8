/// Voxel masks: the file of layers that a scene names.
#include "fuzzed.hpp"
#include "solver/scene/scene.hpp"

namespace {

/// A scene whose body is the mask.
std::string scene_of(const std::string& mask) {
  return fmt::format(R"({{"scene": "masked", "title": "a mask", "bodies": [{{"name": "body",
    "geometry": {{"voxels": {{"file": "{}"}}}}, "element": 0.01,
    "constants": {{"law": "paper"}}}}],
    "run": {{"dt": 1e-6, "steps": 10, "integrator": "rk4"}}}})",
                     mask);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dss::answered_for_file(data, size, ".txt", [](const std::string& mask) {
    const std::string scene = mask + ".json";
    if (!std::filesystem::exists(scene)) std::ofstream(scene) << scene_of(mask);
    dss::load_scene(scene);
  });
}
