#include "solver/scene/voxel_file.hpp"

#include "solver/io/input_file.hpp"
#include "solver/io/voxels/npy.hpp"
#include "solver/io/voxels/voxel_numbers.hpp"
#include "solver/io/voxels/vti.hpp"
#include "solver/scene/cells.hpp"
#include "solver/surface/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace dss {
namespace {

using Layers = std::vector<std::vector<std::string>>; ///< layers by z, lines by y, characters by x

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
  const std::string path = path_beside(node);
  std::ifstream file = open_whole(path, 1, fmt::format("{}: the text of {}", node.where(), path),
                                  "give the scene fewer voxels");
  if (!file.is_open())
    node.fail(fmt::format("voxel file {} cannot be read; its path is relative to the scene's file",
                          path));
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
        const bool is_material = mark >= '1' && mark <= '9';
        if (mark != '#' && mark != '.' && !is_material)
          node.fail(
              fmt::format("layer {}, line {} has '{}'; write # for an element, 1 to 9 for one "
                          "of this material, and . for a hole",
                          z, y, mark));
        grid.occupied[cell++] = is_material ? std::uint8_t(mark - '0') : std::uint8_t(mark == '#');
      }
  return grid;
}

const NumberType& read_number_type(const std::optional<Node>& node) {
  const std::span<const NumberType> types = number_types();
  const std::string name = node ? node->text() : "u1";
  const auto type = std::ranges::find(types, name, &NumberType::name);
  if (type == types.end())
    node->fail(
        fmt::format("\"{}\" is not a type of numbers; types are {}", name, number_type_names()));
  return *type;
}

/// Voxels of a file, and its cells if it has a unit.
VoxelFile read_voxel_file(ObjectNode& voxels, const Node& file) {
  const std::string path = path_beside(file), kind = std::filesystem::path(path).extension();
  const auto read = [&](auto&& reader) { return file.placed(reader); };
  if (kind == ".npy") return {read([&] { return read_npy_voxels(path, max_elements); }), {}, {}};
  if (kind == ".vti") {
    const std::string array = voxels.name_or("array", "");
    const auto unit = voxels.find("unit");
    const double metres = unit ? unit->placed([&] { return length_of_unit(unit->text()); }) : 0;
    ImageVoxels image = read([&] { return read_vti_voxels(path, array, max_elements); });
    if (!unit) return {std::move(image.grid), {}, {}};
    for (std::size_t a = 0; a < 3; ++a) image.spacing[a] *= metres, image.origin[a] *= metres;
    return {std::move(image.grid), image.spacing, image.origin};
  }
  if (kind == ".raw") {
    const GridPoint shape = read_point(voxels.require("shape"), 1);
    const NumberType& type = read_number_type(voxels.find("type"));
    return {read([&] { return read_raw_voxels(path, shape, type, max_elements); }), {}, {}};
  }
  return {grid_of(file, read_layer_file(file)), {}, {}};
}

} // namespace

VoxelFile read_voxels(const Node& node) {
  ObjectNode voxels(node);
  const std::string key = voxels.require_one({"layers", "file"});
  const Node mask = voxels.require(key);
  VoxelFile read = key == "file" ? read_voxel_file(voxels, mask)
                                 : VoxelFile{grid_of(mask, read_layers(mask)), {}, {}};
  voxels.finish();
  return read;
}

} // namespace dss
