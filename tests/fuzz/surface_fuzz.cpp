/// Surfaces: STL files, and the bodies inside of them.
#include "fuzzed.hpp"
#include "solver/surface/shape_report.hpp"
#include "solver/surface/stl.hpp"
#include "solver/surface/voxelize.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return dss::answered_for_file(data, size, ".stl", [](const std::string& path) {
    const dss::Surface surface = dss::read_stl(path, {});
    const Eigen::Vector3d edge = Eigen::Vector3d::Constant(dss::edge_for(surface, 12));
    const dss::SpaceGrid grid = dss::grid_around(surface, edge, 20000);
    for (const dss::SurfaceRule rule : {dss::SurfaceRule::winding, dss::SurfaceRule::closed})
      dss::report_shape(surface, grid, dss::filled(surface, grid, rule));
  });
}
