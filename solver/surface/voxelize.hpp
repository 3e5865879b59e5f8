#pragma once
/// Bodies of voxels from surfaces: an element is a cell whose centre the surface encloses.
#include "solver/lattice/lattice.hpp"
#include "solver/surface/crossings.hpp"
#include "solver/surface/surface.hpp"

#include <string>

namespace dss {

/// Which surfaces are accepted.
enum class SurfaceRule {
  closed, ///< closed, without overlaps: each line enters and leaves it in turn
  /// Any. Cells with a winding number of at least 1/2 are filled, of either sign: overlapping parts
  /// are joined, and holes are closed by a smooth skin.
  winding
};

/// The edge of cubes [m], `count` along the longest side of a surface.
/// @throws InputError if that side is longer than 100 m: most probably its unit is another one
double edge_for(const Surface& surface, long count);

/// The cells around a surface. The grid is centred on it, so that it is as symmetric as the
/// surface, and meets faces whose distance is a whole number of cells.
/// @param edge        of a cell [m]
/// @param most_cells  that a grid may have
/// @throws InputError if a cell is larger than the surface along an axis, or for too many cells
SpaceGrid grid_around(const Surface& surface, const Eigen::Vector3d& edge, long most_cells);

/// Reads "closed" or "winding". @throws InputError
SurfaceRule surface_rule(const std::string& name);

/// Fills the cells inside a surface.
/// @throws InputError if the surface does not keep the rule, or encloses no centre of a cell; for
///     `winding` if more than 1 % of the filled cells are unclear: winding numbers of 0.25 to 0.75
VoxelGrid filled(const Surface& surface, const SpaceGrid& grid, SurfaceRule rule);

} // namespace dss
