#pragma once
/// Numbers and sizes of cells, and files beside a scene, as all readers of shapes need them.
#include "solver/json/node.hpp"
#include "solver/lattice/lattice.hpp"

#include <array>
#include <string>

namespace dss {

/// Most elements of a scene, over all bodies.
constexpr long max_elements = (1L << 31) - 1;

/// Reads the size of an element: a length, or three lengths along x, y, z [m].
Vec3 read_element(const Node& node);

/// The path of a file that a scene names: relative to the scene's file unless it is absolute.
std::string path_beside(const Node& node);

using GridPoint = std::array<long, 3>;
/// Reads three whole numbers, at least `least`.
GridPoint read_point(const Node& node, long least);
/// A grid without elements. @throws InputError if it is too large, or does not fit into memory
VoxelGrid empty_grid(const Node& node, const GridPoint& size);
/// Product of three sizes, in double, because it may overflow 64 bits.
/// @throws InputError for more than max_elements
double cells_of(const Node& node, const GridPoint& size);

} // namespace dss
