#pragma once
/// Faces of CAD surfaces, and what of a body lies along them.
#include "solver/json/object_node.hpp"
#include "solver/model/problem.hpp"
#include "solver/surface/surface.hpp"

#include <array>
#include <optional>
#include <vector>

namespace dss {

/// Reads {"near", "angle"}: the face of the surface next to a point. It goes on over edges at which
/// normals turn by less than the angle [degrees]. The point is within a tenth of the surface's
/// diagonal of it.
/// @return elements that the face passes within half of their diagonal, in units of elements;
///     ascending
std::vector<std::size_t> read_cad_face(const Node& node, const Problem& problem, int body,
                                       const std::optional<Surface>& surface);

/// Reads the same. The free face of an element belongs to the CAD face if the line from its centre
/// across this face leaves the surface there, before the centre of the next cell. So the
/// projections of these faces onto any plane add up to that of the CAD face, but for its edge.
/// @return elements with such a face -x, +x, -y, +y, -z, +z; ascending
std::array<std::vector<std::size_t>, 6> read_cad_sides(const Node& node, const Problem& problem,
                                                       int body,
                                                       const std::optional<Surface>& surface);

} // namespace dss
