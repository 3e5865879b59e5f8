#pragma once
/// Selection of elements by where they are: by places in space, and by faces of CAD surfaces.
#include "solver/json/object_node.hpp"
#include "solver/model/problem.hpp"
#include "solver/surface/surface.hpp"

#include <optional>
#include <vector>

namespace dss {

/// Of each body the surface that it was made from, if any. Its places are those of the scene.
using BodySurfaces = std::vector<std::optional<Surface>>;

/// Keys of selections by place.
extern const std::vector<std::string> place_keys;

/// Reads the value of one of place_keys. Places are those of the scene at rest [m].
///   region    {"from", "to"}: the centre of the element lies in this box
///   plane     {"point", "normal"}: the plane cuts the element. One that lies between two layers
///             takes the layer to which its normal points.
///   cylinder  {"from", "to", "radius"}: the centre lies in this cylinder
///   cad_face  {"near", "angle"}: see read_cad_face
/// @return elements of the body, ascending; none if the selection is empty
std::vector<std::size_t> read_place(const std::string& key, const Node& node,
                                    const Problem& problem, int body,
                                    const std::optional<Surface>& surface);

} // namespace dss
