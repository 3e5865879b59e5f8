#include "solver/lattice/element_nodes.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace dss {
namespace {

constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();

/// The nodes of one plane z = const of a body.
class Plane {
public:
  Plane(int nx, int ny) : width_(std::size_t(nx)), nodes_(width_ * std::size_t(ny), no_node) {}
  std::uint32_t& at(int x, int y) { return nodes_[std::size_t(y) * width_ + std::size_t(x)]; }
  void clear() { std::fill(nodes_.begin(), nodes_.end(), no_node); }

private:
  std::size_t width_;
  std::vector<std::uint32_t> nodes_;
};

/// A plane that holds the nodes of the body that begins with a row.
Plane plane_of(const Lattice& lattice, std::size_t first) {
  int width = 0, depth = 0; // cells
  const int body = lattice.rows[first].body;
  for (std::size_t r = first; r < lattice.rows.size() && lattice.rows[r].body == body; ++r) {
    width = std::max(width, lattice.rows[r].x_end);
    depth = std::max(depth, lattice.rows[r].y + 1);
  }
  return {width + 1, depth + 1};
}

} // namespace

/// Goes through each body from plane to plane, as its rows do.
ElementNodes::ElementNodes(const Lattice& lattice) : nodes_(lattice.element_count) {
  std::array<Plane, 2> planes{Plane(0, 0), Plane(0, 0)};
  const Row* last = nullptr;
  for (std::size_t r = 0; r < lattice.rows.size(); ++r) {
    const Row& row = lattice.rows[r];
    if (last == nullptr || row.body != last->body) {
      planes.fill(plane_of(lattice, r));
    } else if (row.z != last->z) {
      if (row.z == last->z + 1)
        std::swap(planes[0], planes[1]);
      else
        planes[0].clear();
      planes[1].clear();
    }
    last = &row;
    std::size_t element = row.first_element;
    for (int x = row.x_begin; x < row.x_end; ++x) {
      if (!lattice.is_present(row, x)) continue;
      for (std::size_t corner = 0; corner < 8; ++corner) {
        std::uint32_t& node =
            planes[corner >> 2].at(x + int(corner & 1), row.y + int(corner >> 1 & 1));
        if (node == no_node) node = std::uint32_t(count_++);
        nodes_[element][corner] = node;
      }
      ++element;
    }
  }
}

} // namespace dss
