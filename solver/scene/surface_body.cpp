#include "solver/scene/surface_body.hpp"

#include "solver/scene/cells.hpp"
#include "solver/surface/stl.hpp"

namespace dss {
namespace {

SurfacePlacement read_placement(ObjectNode& surface) {
  SurfacePlacement placement;
  const Node unit = surface.require("unit");
  placement.unit = unit.placed([&] { return length_of_unit(unit.text()); });
  if (const auto axes = surface.find("axes"))
    axes->placed([&] { placement.set_axes(axes->names()); });
  return placement;
}

Eigen::Vector3d read_edge(const Node& element, const Surface& surface) {
  if (!element.is_object()) {
    const Vec3 edge = read_element(element);
    return {edge[0], edge[1], edge[2]};
  }
  ObjectNode object(element);
  const long count = object.require("count").whole(1, max_elements);
  object.finish();
  return Eigen::Vector3d::Constant(element.placed([&] { return edge_for(surface, count); }));
}

} // namespace

SurfaceBody read_surface_body(const Node& node, const Node& element) {
  ObjectNode object(node);
  const Node file = object.require("file");
  const SurfacePlacement placement = read_placement(object);
  SurfaceBody body;
  if (const auto rule = object.find("surface"))
    body.rule = rule->placed([&] { return surface_rule(rule->text()); });
  object.finish();
  body.surface = file.placed([&] { return read_stl(path_beside(file), placement); });
  const Eigen::Vector3d edge = read_edge(element, body.surface);
  body.grid = node.placed([&] { return grid_around(body.surface, edge, max_elements); });
  return body;
}

} // namespace dss
