#pragma once
/// The shapes of the bodies of a scene.
#include "solver/json/object_node.hpp"
#include "solver/lattice/lattice.hpp"
#include "solver/scene/cells.hpp"
#include "solver/surface/surface.hpp"

#include <optional>

namespace dss {

/// The cells of a body, their size and their place.
struct BodyShape {
  VoxelGrid grid;
  Vec3 edge{};                    ///< of a cell [m]
  Vec3 origin{};                  ///< low corner of cell (0, 0, 0) [m]
  std::optional<Surface> surface; ///< that it was made from; its places are those of the scene
};

/// Reads "geometry", "element" and "origin" of a body.
/// @throws InputError for an empty shape, or for a grid of more than max_elements cells
BodyShape read_shape(ObjectNode& body);

/// Bounds of the size of a shape, or of all shapes of a scene.
struct ShapeSize {
  double cells = 0;          ///< of its grid: elements are at most that
  double least_elements = 0; ///< 0 where only its cells tell
};

/// Finds the size of a body's shape without building it. @throws InputError as read_shape
ShapeSize shape_size(ObjectNode& body);

} // namespace dss
