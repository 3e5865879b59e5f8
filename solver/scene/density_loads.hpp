#pragma once
/// Loads by area or volume: "traction", "pressure" and "body_force".
#include "solver/json/object_node.hpp"
#include "solver/model/problem.hpp"
#include "solver/scene/place_selection.hpp"

#include <vector>

namespace dss {

/// Keys of loads by area or volume.
extern const std::vector<std::string> density_keys;

/// Reads a load that has one of density_keys and a "select". A traction or pressure acts in the
/// middle of a face of each element: the one that "select" names, or, for a pressure, those along a
/// CAD face. A density may be an expression over the place x, y, z [m], which is the middle of the
/// face or the centre of the element.
/// @return one load for each direction of faces; if the density depends on the place, one for each
///     element and face
std::vector<Load> read_density_loads(ObjectNode& object, const Problem& problem, int body,
                                     const BodySurfaces& surfaces);

} // namespace dss
