#include "solver/surface/crossings.hpp"

#include "solver/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace dss {
namespace {

using Eigen::Vector2d;

/// Side of an edge on which a point lies: 1 left, -1 right. A point on the edge counts as shifted
/// by (e, e^2), e > 0 infinitely small, so that a line through an edge or a corner of a closed
/// surface crosses it as a line beside it does (simulation of simplicity: Edelsbrunner, Muecke,
/// 1990). Both triangles of an edge compute the same numbers.
int side_of(Vector2d from, Vector2d to, const Vector2d& point) {
  const bool is_swapped = std::pair(to.x(), to.y()) < std::pair(from.x(), from.y());
  if (is_swapped) std::swap(from, to);
  const Vector2d edge = to - from, reach = point - from;
  double side = edge.x() * reach.y() - edge.y() * reach.x();
  if (side == 0) side = -edge.y();
  if (side == 0) side = edge.x();
  const int sign = (side > 0) - (side < 0);
  return is_swapped ? -sign : sign;
}

/// Cells with their centres within [low, high].
std::pair<int, int> cells_between(const SpaceGrid& grid, int axis, double low, double high) {
  // One more on each side; rounding may move a centre.
  const auto cell = [&](double at) { return (at - grid.low[axis]) / grid.edge[axis] - 0.5; };
  const double most = grid.count[std::size_t(axis)];
  return {int(std::clamp(std::ceil(cell(low)) - 1, 0.0, most)),
          int(std::clamp(std::floor(cell(high)) + 2, 0.0, most))};
}

} // namespace

std::vector<Span> spans(const std::vector<Crossing>& line, int axis) {
  std::vector<Span> inside;
  int winding = 0;
  const Crossing* in = nullptr;
  int most = 0;
  for (const Crossing& crossing : line) {
    const int before = winding;
    winding += crossing.normal[axis] < 0 ? 1 : -1;
    if (before == 0) in = &crossing, most = 0;
    most = std::max(most, std::abs(winding));
    if (winding == 0) inside.push_back({*in, crossing, most});
  }
  return inside;
}

Crossings::Crossings(const Surface& surface, const SpaceGrid& grid, int axis) {
  const auto [u, v] = across(axis);
  count_u_ = grid.count[std::size_t(u)];
  const std::size_t lines = std::size_t(count_u_) * std::size_t(grid.count[std::size_t(v)]);
  // A list and a few crossings each.
  require_memory(150 * double(lines),
                 fmt::format("surface {}: {} lines along {}", surface.path, lines, "xyz"[axis]),
                 "take larger cells");
  lines_.resize(lines);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto corners = surface.corners_of(t);
    const Eigen::Vector3d area = surface.area_of(t);
    if (area[axis] == 0) continue; // no line along the axis crosses it
    const auto flat = [&, u = u, v = v](std::size_t n) {
      return Vector2d(corners[n][u], corners[n][v]);
    };
    const Vector2d a = flat(0), b = flat(1), c = flat(2);
    const Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const auto [first_u, last_u] = cells_between(grid, u, low.x(), high.x());
    const auto [first_v, last_v] = cells_between(grid, v, low.y(), high.y());
    const Eigen::Vector3d normal = area.normalized();
    for (int y = first_v; y < last_v; ++y)
      for (int x = first_u; x < last_u; ++x) {
        const Vector2d point(grid.centre(u, x), grid.centre(v, y));
        const int side = side_of(a, b, point);
        if (side == 0 || side_of(b, c, point) != side || side_of(c, a, point) != side) continue;
        // The plane: area . (p - corner) = 0.
        const double at = corners[0][axis] - (area[u] * (point.x() - corners[0][u]) +
                                              area[v] * (point.y() - corners[0][v])) /
                                                 area[axis];
        lines_[std::size_t(y) * std::size_t(count_u_) + std::size_t(x)].push_back({at, normal, t});
      }
  }
  for (std::vector<Crossing>& line : lines_) std::ranges::sort(line, {}, &Crossing::at);
}

} // namespace dss
