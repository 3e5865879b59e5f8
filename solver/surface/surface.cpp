#include "solver/surface/surface.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace dss {
namespace {

using Corners = std::pair<std::uint32_t, std::uint32_t>;

/// An edge of a triangle. Both triangles of a closed surface have the same `ends`.
struct Edge {
  Corners ends; ///< ascending
  bool is_ascending = false;
  std::uint32_t triangle = 0;
  std::uint8_t side = 0;
};

/// All edges of all triangles; those with the same ends follow one another.
std::vector<Edge> sorted_edges(const Surface& surface) {
  std::vector<Edge> edges;
  edges.reserve(3 * surface.triangles.size());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    for (std::uint8_t side = 0; side < 3; ++side) {
      const std::uint32_t from = surface.triangles[t][side],
                          to = surface.triangles[t][(side + 1U) % 3U];
      edges.push_back({std::minmax(from, to), from < to, t, side});
    }
  std::ranges::sort(edges, {}, &Edge::ends);
  return edges;
}

/// Calls visit(first, last) for the edges between the same two corners.
template <class Visit>
void each_line(const std::vector<Edge>& edges, Visit&& visit) {
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last =
        std::find_if(first, edges.end(), [&](const Edge& e) { return e.ends != first->ends; });
    visit(first, last);
    first = last;
  }
}

} // namespace

Eigen::Vector3d Surface::area_of(std::size_t triangle) const {
  const auto [a, b, c] = corners_of(triangle);
  return (b - a).cross(c - a) / 2;
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds(const Surface& surface) {
  Eigen::Vector3d low = surface.corners.front(), high = low;
  for (const Eigen::Vector3d& corner : surface.corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return {low, high};
}

double enclosed_volume(const Surface& surface) {
  const Eigen::Vector3d origin = surface.corners.front();
  double volume = 0; // of the tetrahedra from one point to all triangles
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    volume += surface.area_of(t).dot(surface.corners_of(t)[0] - origin) / 3;
  return volume;
}

std::size_t unpaired_edges(const Surface& surface) {
  std::size_t count = 0;
  each_line(sorted_edges(surface), [&](auto first, auto last) {
    const auto ascending = std::count_if(first, last, [](const Edge& e) { return e.is_ascending; });
    if (2 * ascending != last - first) ++count;
  });
  return count;
}

std::vector<std::array<std::uint32_t, 3>> triangle_neighbours(const Surface& surface) {
  std::vector<std::array<std::uint32_t, 3>> neighbours(surface.triangles.size());
  for (std::uint32_t t = 0; t < neighbours.size(); ++t) neighbours[t].fill(t);
  each_line(sorted_edges(surface), [&](auto first, auto last) {
    if (last - first != 2) return;
    neighbours[first->triangle][first->side] = (first + 1)->triangle;
    neighbours[(first + 1)->triangle][(first + 1)->side] = first->triangle;
  });
  return neighbours;
}

} // namespace dss
