#pragma once
/// Bodies inside of the surfaces of STL files.
#include "solver/json/object_node.hpp"
#include "solver/surface/voxelize.hpp"

namespace dss {

/// A surface that a scene names, and the cells of its body.
struct SurfaceBody {
  Surface surface;
  SpaceGrid grid;
  SurfaceRule rule = SurfaceRule::closed;
};

/// Reads {"file", "unit", "axes", "surface"} and the size of elements: a length, three lengths, or
/// {"count": N}, so many cubes along the longest side.
/// @throws InputError as read_stl and grid_around
SurfaceBody read_surface_body(const Node& node, const Node& element);

} // namespace dss
