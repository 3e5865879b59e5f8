#include "solver/scene/geometry.hpp"

#include "solver/memory.hpp"
#include "solver/scene/surface_body.hpp"
#include "solver/scene/voxel_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace dss {
namespace {

void fill(VoxelGrid& grid, const GridPoint& from, const GridPoint& size,
          std::uint8_t material = 1) {
  for (long z = from[2]; z < from[2] + size[2]; ++z)
    for (long y = from[1]; y < from[1] + size[1]; ++y) {
      const auto row = grid.occupied.begin() + ((z * grid.ny + y) * grid.nx + from[0]);
      std::fill(row, row + size[0], material);
    }
}

struct CellBox {
  GridPoint from{}, size{};
  std::uint8_t material = 1;
};
struct Boxes {
  std::vector<CellBox> all; ///< a later one covers those before it
  GridPoint extent{};
};

Boxes read_box_list(const Node& node) {
  Boxes boxes;
  for (const Node& item : node.items()) {
    ObjectNode box(item);
    const GridPoint from = read_point(box.require("from"), 0),
                    size = read_point(box.require("size"), 1);
    const auto material = box.find("material");
    boxes.all.push_back({from, size, std::uint8_t(material ? material->whole(1, 255) : 1)});
    box.finish();
    for (std::size_t a = 0; a < 3; ++a)
      boxes.extent[a] = std::max(boxes.extent[a], from[a] + size[a]);
  }
  if (boxes.all.empty()) node.fail("no boxes; a body has at least one element");
  return boxes;
}

VoxelGrid read_boxes(const Node& node) {
  const Boxes boxes = read_box_list(node);
  VoxelGrid grid = empty_grid(node, boxes.extent);
  for (const CellBox& box : boxes.all) fill(grid, box.from, box.size, box.material);
  return grid;
}

void require_element(const Node& node, const VoxelGrid& grid, const char* what) {
  if (std::ranges::all_of(grid.occupied, [](std::uint8_t cell) { return cell == 0; }))
    node.fail(fmt::format("{} has no element; a body has at least one", what));
}

/// A box of which a part of the cells are elements, chosen at random. A seed gives the same body on
/// every machine.
VoxelGrid read_porous(const Node& node) {
  ObjectNode porous(node);
  const Node filling = porous.require("filling");
  const double part = filling.positive();
  if (part > 1)
    filling.fail(
        fmt::format("{:g} is more than 1; it is the part of the cells that are elements", part));
  VoxelGrid grid = empty_grid(node, read_point(porous.require("size"), 1));
  const std::optional<Node> seed = porous.find("seed");
  std::mt19937 generator(std::uint32_t(seed ? seed->whole(0, max_elements) : 1));
  porous.finish();
  for (std::uint8_t& cell : grid.occupied) cell = double(generator()) < part * 0x1p32;
  require_element(node, grid, "the porous body");
  return grid;
}

/// Struts along the edges of cubes of `cell` elements: where at least two of the three coordinates
/// lie in a strut.
VoxelGrid read_struts(const Node& node) {
  ObjectNode struts(node);
  VoxelGrid grid = empty_grid(node, read_point(struts.require("size"), 1));
  const long cell = struts.require("cell").whole(1, max_elements),
             thickness = struts.require("thickness").whole(1, cell);
  struts.finish();
  std::size_t n = 0;
  for (long z = 0; z < grid.nz; ++z)
    for (long y = 0; y < grid.ny; ++y)
      for (long x = 0; x < grid.nx; ++x)
        grid.occupied[n++] =
            int(x % cell < thickness) + int(y % cell < thickness) + int(z % cell < thickness) >= 2;
  return grid;
}

const std::vector<std::string> geometry_kinds = {"box", "boxes",  "voxels",
                                                 "stl", "porous", "struts"};

/// The only key of a geometry, and its value.
std::pair<std::string, Node> kind_of(const Node& geometry) {
  ObjectNode shape(geometry);
  const std::string key = shape.require_one(geometry_kinds);
  const Node what = shape.require(key);
  shape.finish();
  return {key, what};
}

VoxelGrid read_cells(const std::string& kind, const Node& what) {
  if (kind == "boxes") return read_boxes(what);
  if (kind == "porous") return read_porous(what);
  if (kind == "struts") return read_struts(what);
  const GridPoint size = read_point(what, 1);
  VoxelGrid grid = empty_grid(what, size);
  fill(grid, {0, 0, 0}, size);
  return grid;
}

BodyShape read_stl_shape(const Node& what, const Node& element) {
  SurfaceBody body = read_surface_body(what, element);
  BodyShape shape;
  shape.grid = what.placed([&] { return filled(body.surface, body.grid, body.rule); });
  for (std::size_t a = 0; a < 3; ++a) {
    shape.edge[a] = body.grid.edge[Eigen::Index(a)];
    shape.origin[a] = body.grid.low[Eigen::Index(a)];
  }
  shape.surface = std::move(body.surface);
  return shape;
}

BodyShape read_voxel_shape(ObjectNode& body, const Node& what) {
  VoxelFile voxels = read_voxels(what);
  require_element(what, voxels.grid, "the voxel mask");
  if (!voxels.edge) return {std::move(voxels.grid), read_element(body.require("element")), {}, {}};
  if (const auto element = body.find("element"))
    element->fail("the image has a unit, so its spacing is the size of an element; leave one out");
  return {std::move(voxels.grid), *voxels.edge, *voxels.origin, {}};
}

} // namespace

BodyShape read_shape(ObjectNode& body) {
  const auto [kind, what] = kind_of(body.require("geometry"));
  BodyShape shape =
      kind == "stl" ? read_stl_shape(what, body.require("element"))
      : kind == "voxels"
          ? read_voxel_shape(body, what)
          : BodyShape{read_cells(kind, what), read_element(body.require("element")), {}, {}};
  const Vec3 origin = body.vector_or("origin", {});
  for (std::size_t a = 0; a < 3; ++a) shape.origin[a] += origin[a];
  if (shape.surface)
    for (Eigen::Vector3d& corner : shape.surface->corners)
      corner += Eigen::Vector3d(origin[0], origin[1], origin[2]);
  return shape;
}

ShapeSize shape_size(ObjectNode& body) {
  const auto [kind, what] = kind_of(body.require("geometry"));
  if (kind == "stl")
    return {double(read_surface_body(what, body.require("element")).grid.cells()), 0};
  if (kind == "voxels") {
    const VoxelGrid grid = read_voxels(what).grid;
    const auto holes = std::ranges::count(grid.occupied, 0);
    return {double(grid.occupied.size()), double(grid.occupied.size()) - double(holes)};
  }
  if (kind == "box") {
    const double cells = cells_of(what, read_point(what, 1));
    return {cells, cells};
  }
  if (kind != "boxes") return {cells_of(what, read_point(ObjectNode(what).require("size"), 1)), 0};
  const Boxes boxes = read_box_list(what);
  ShapeSize size{cells_of(what, boxes.extent), 0};
  for (const CellBox& box : boxes.all)
    size.least_elements = std::max(size.least_elements, cells_of(what, box.size));
  return size;
}

} // namespace dss
