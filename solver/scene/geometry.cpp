#include "solver/scene/geometry.hpp"

#include "solver/io/input_file.hpp"
#include "solver/io/npy.hpp"
#include "solver/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace dss {
namespace {

using GridPoint = std::array<long, 3>;
using Layers = std::vector<std::vector<std::string>>; ///< layers by z, lines by y, characters by x

GridPoint read_point(const Node& node, long least) {
  node.vector(); // checks the shape of the array
  const std::vector<Node> parts = node.items();
  return {parts[0].whole(least, max_elements), parts[1].whole(least, max_elements),
          parts[2].whole(least, max_elements)};
}

/// Cells of a grid, at most max_elements. In double, because the product of three such sizes
/// overflows 64 bits.
double cells_of(const Node& node, const GridPoint& size) {
  const double cells = double(size[0]) * double(size[1]) * double(size[2]);
  if (cells > double(max_elements))
    node.fail(fmt::format("{} x {} x {} cells are too many; at most {} are allowed", size[0],
                          size[1], size[2], max_elements));
  return cells;
}

VoxelGrid empty_grid(const Node& node, const GridPoint& size) {
  // The grid and the lattice that is made from it take a byte each.
  require_memory(2 * cells_of(node, size),
                 fmt::format("{}: {} x {} x {} cells", node.where(), size[0], size[1], size[2]),
                 "give the scene fewer");
  VoxelGrid grid{int(size[0]), int(size[1]), int(size[2]), {}};
  grid.occupied.assign(std::size_t(size[0] * size[1] * size[2]), 0);
  return grid;
}

void fill(VoxelGrid& grid, const GridPoint& from, const GridPoint& size) {
  for (long z = from[2]; z < from[2] + size[2]; ++z)
    for (long y = from[1]; y < from[1] + size[1]; ++y) {
      const auto row = grid.occupied.begin() + ((z * grid.ny + y) * grid.nx + from[0]);
      std::fill(row, row + size[0], std::uint8_t(1));
    }
}

/// Boxes: where each begins, and its size.
struct Boxes {
  std::vector<std::pair<GridPoint, GridPoint>> all;
  GridPoint extent{};
};

Boxes read_box_list(const Node& node) {
  Boxes boxes;
  for (const Node& item : node.items()) {
    ObjectNode box(item);
    const GridPoint from = read_point(box.require("from"), 0),
                    size = read_point(box.require("size"), 1);
    box.finish();
    for (std::size_t a = 0; a < 3; ++a)
      boxes.extent[a] = std::max(boxes.extent[a], from[a] + size[a]);
    boxes.all.emplace_back(from, size);
  }
  if (boxes.all.empty()) node.fail("no boxes; a body has at least one element");
  return boxes;
}

VoxelGrid read_boxes(const Node& node) {
  const Boxes boxes = read_box_list(node);
  VoxelGrid grid = empty_grid(node, boxes.extent);
  for (const auto& [from, size] : boxes.all) fill(grid, from, size);
  return grid;
}

Layers read_layers(const Node& node) {
  Layers layers;
  for (const Node& layer : node.items()) {
    layers.emplace_back();
    for (const Node& line : layer.items()) layers.back().push_back(line.text());
  }
  return layers;
}

/// Layers of a text file. A blank line or the end of the file ends a layer. The path is relative to
/// the scene's file unless it is absolute.
Layers read_layer_file(const Node& node) {
  const auto path = std::filesystem::path(node.file()).parent_path() / node.text();
  std::ifstream file =
      open_whole(path, 1, fmt::format("{}: the text of {}", node.where(), path.string()),
                 "give the scene fewer voxels");
  if (!file.is_open())
    node.fail(fmt::format("voxel file {} cannot be read; its path is relative to the scene's file",
                          path.string()));
  Layers layers(1);
  for (std::string line; std::getline(file, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (!line.empty())
      layers.back().push_back(line);
    else if (!layers.back().empty())
      layers.emplace_back();
  }
  if (layers.back().empty()) layers.pop_back();
  return layers;
}

/// Requires that all lines are of one length, and all layers of as many lines.
void require_box(const Node& node, const Layers& layers) {
  if (layers.empty() || layers[0].empty() || layers[0][0].empty())
    node.fail("the voxel mask is empty; a body has at least one element");
  const std::size_t nx = layers[0][0].size(), ny = layers[0].size();
  for (std::size_t z = 0; z < layers.size(); ++z) {
    if (layers[z].size() != ny)
      node.fail(fmt::format("layer {} has {} lines; layer 0 has {}", z, layers[z].size(), ny));
    for (std::size_t y = 0; y < ny; ++y) {
      const std::string& line = layers[z][y];
      if (line.size() != nx)
        node.fail(fmt::format("layer {}, line {} has {} characters; the first line has {}", z, y,
                              line.size(), nx));
    }
  }
}

VoxelGrid grid_of(const Node& node, const Layers& layers) {
  require_box(node, layers); // before the grid takes memory
  VoxelGrid grid =
      empty_grid(node, {long(layers[0][0].size()), long(layers[0].size()), long(layers.size())});
  std::size_t cell = 0;
  for (std::size_t z = 0; z < layers.size(); ++z)
    for (std::size_t y = 0; y < layers[z].size(); ++y)
      for (const char mark : layers[z][y]) {
        if (mark != '#' && mark != '.')
          node.fail(fmt::format(
              "layer {}, line {} has '{}'; write # for an element and . for a hole", z, y, mark));
        grid.occupied[cell++] = mark == '#';
      }
  return grid;
}

/// An array of NumPy. The path is relative to the scene's file unless it is absolute.
VoxelGrid read_array_file(const Node& node) {
  const auto path = std::filesystem::path(node.file()).parent_path() / node.text();
  NpyMask mask = node.placed([&] { return read_npy_mask(path.string(), max_elements); });
  return {int(mask.shape[0]), int(mask.shape[1]), int(mask.shape[2]), std::move(mask.cells)};
}

VoxelGrid read_voxels(const Node& node) {
  ObjectNode voxels(node);
  const std::string key = voxels.require_one({"layers", "file"});
  const Node mask = voxels.require(key);
  voxels.finish();
  if (key == "file" && mask.text().ends_with(".npy")) return read_array_file(mask);
  return grid_of(mask, key == "file" ? read_layer_file(mask) : read_layers(mask));
}

void require_element(const Node& node, const VoxelGrid& grid, const char* what) {
  if (std::find(grid.occupied.begin(), grid.occupied.end(), 1) == grid.occupied.end())
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

} // namespace

VoxelGrid read_geometry(const Node& node) {
  ObjectNode shape(node);
  const std::string key = shape.require_one({"box", "boxes", "voxels", "porous", "struts"});
  const Node what = shape.require(key);
  shape.finish();
  if (key == "boxes") return read_boxes(what);
  if (key == "porous") return read_porous(what);
  if (key == "struts") return read_struts(what);
  if (key == "box") {
    const GridPoint size = read_point(what, 1);
    VoxelGrid grid = empty_grid(what, size);
    fill(grid, {0, 0, 0}, size);
    return grid;
  }
  VoxelGrid grid = read_voxels(what);
  require_element(what, grid, "the voxel mask");
  return grid;
}

ShapeSize shape_size(const Node& node) {
  ObjectNode shape(node);
  const std::string key = shape.require_one({"box", "boxes", "voxels", "porous", "struts"});
  const Node what = shape.require(key);
  if (key == "voxels") {
    const VoxelGrid grid = read_voxels(what);
    return {double(grid.occupied.size()), double(std::ranges::count(grid.occupied, 1))};
  }
  if (key == "box") {
    const double cells = cells_of(what, read_point(what, 1));
    return {cells, cells};
  }
  if (key != "boxes") return {cells_of(what, read_point(ObjectNode(what).require("size"), 1)), 0};
  const Boxes boxes = read_box_list(what);
  ShapeSize size{cells_of(what, boxes.extent), 0};
  for (const auto& [from, extent] : boxes.all)
    size.least_elements = std::max(size.least_elements, cells_of(what, extent));
  return size;
}

} // namespace dss
