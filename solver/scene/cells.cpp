#include "solver/scene/cells.hpp"

#include "solver/memory.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace dss {

double cells_of(const Node& node, const GridPoint& size) {
  const double cells = double(size[0]) * double(size[1]) * double(size[2]);
  if (cells > double(max_elements))
    node.fail(fmt::format("{} x {} x {} cells are too many; at most {} are allowed", size[0],
                          size[1], size[2], max_elements));
  return cells;
}

GridPoint read_point(const Node& node, long least) {
  node.vector(); // checks the shape of the array
  const std::vector<Node> parts = node.items();
  return {parts[0].whole(least, max_elements), parts[1].whole(least, max_elements),
          parts[2].whole(least, max_elements)};
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

Vec3 read_element(const Node& node) {
  if (node.is_array()) return node.positive_vector();
  Vec3 edge{};
  edge.fill(node.positive());
  return edge;
}

std::string path_beside(const Node& node) {
  return (std::filesystem::path(node.file()).parent_path() / node.text()).string();
}

} // namespace dss
