#pragma once
/// Surfaces from STL files.
#include "solver/surface/placement.hpp"
#include "solver/surface/surface.hpp"

#include <string>

namespace dss {

/// Reads a binary or ASCII file. Equal corners are joined, triangles without area at an edge are
/// left out. The normals of the file are not used; the order of the corners tells the outer side.
/// @throws InputError with the file: one that cannot be read, is no STL file, is cut off, has a
///     number that is not finite, or no triangle
Surface read_stl(const std::string& path, const SurfacePlacement& placement);

} // namespace dss
