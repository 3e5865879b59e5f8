#include "solver/surface/shape_report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace dss {
namespace {

/// Greatest cosine between the outer normals of two faces of a wall: 18 degrees from parallel.
constexpr double parallel_cosine = -0.95;

/// Distance of two nearly parallel faces, from a line that enters at one and leaves at the other.
std::optional<Wall> wall_between(const Crossing& in, const Crossing& out, int axis,
                                 const SpaceGrid& grid) {
  if (in.normal.dot(out.normal) > parallel_cosine) return std::nullopt;
  const Eigen::Vector3d normal = (out.normal - in.normal).normalized();
  Wall wall;
  wall.thickness = (out.at - in.at) * std::abs(normal[axis]);
  if (wall.thickness <= 0) return std::nullopt;
  wall.elements = wall.thickness * normal.cwiseQuotient(grid.edge).norm();
  return wall;
}

/// Looks along lines through the centres of cells.
class LineReport {
public:
  LineReport(const Surface& surface, const SpaceGrid& grid) : grid_(grid) {
    for (int axis = 0; axis < 3; ++axis) look_along(axis, Crossings(surface, grid, axis));
  }
  const std::optional<Wall>& thinnest() const { return thinnest_; }
  /// Volume inside, the mean over the three axes [m^3].
  double volume() const { return volume_; }
  /// Whether a place on a line along x is enclosed more than once.
  bool has_overlaps() const { return has_overlaps_; }

private:
  void look_along(int axis, const Crossings& crossings) {
    const auto [u, v] = Crossings::across(axis);
    const double area = grid_.edge[u] * grid_.edge[v];
    for (int y = 0; y < grid_.count[std::size_t(v)]; ++y)
      for (int x = 0; x < grid_.count[std::size_t(u)]; ++x)
        for (const Span& span : spans(crossings.of_line(x, y), axis)) {
          volume_ += area * (span.out.at - span.in.at) / 3;
          has_overlaps_ |= axis == 0 && span.most_enclosed > 1;
          std::optional<Wall> wall = wall_between(span.in, span.out, axis, grid_);
          if (!wall || (thinnest_ && wall->elements >= thinnest_->elements)) continue;
          wall->place[axis] = (span.in.at + span.out.at) / 2;
          wall->place[u] = grid_.centre(u, x);
          wall->place[v] = grid_.centre(v, y);
          thinnest_ = wall;
        }
  }

  const SpaceGrid& grid_;
  std::optional<Wall> thinnest_;
  double volume_ = 0;
  bool has_overlaps_ = false;
};

} // namespace

std::vector<std::size_t> pieces_of(const VoxelGrid& voxels) {
  const std::size_t nx = std::size_t(voxels.nx), layer = nx * std::size_t(voxels.ny);
  std::vector<std::uint8_t> is_left(voxels.occupied.size());
  std::ranges::transform(voxels.occupied, is_left.begin(), [](auto cell) { return cell != 0; });
  std::vector<std::size_t> pieces, waiting;
  for (std::size_t first = 0; first < is_left.size(); ++first) {
    if (is_left[first] == 0) continue;
    std::size_t count = 0;
    const auto take = [&](bool is_inside, std::size_t cell) {
      if (!is_inside || is_left[cell] == 0) return;
      is_left[cell] = 0;
      waiting.push_back(cell);
    };
    take(true, first);
    while (!waiting.empty()) {
      const std::size_t cell = waiting.back();
      waiting.pop_back();
      ++count;
      const std::size_t x = cell % nx, y = cell % layer / nx;
      take(x > 0, cell - 1);
      take(x + 1 < nx, cell + 1);
      take(y > 0, cell - nx);
      take(y + 1 < std::size_t(voxels.ny), cell + nx);
      take(cell >= layer, cell - layer);
      take(cell + layer < is_left.size(), cell + layer);
    }
    pieces.push_back(count);
  }
  std::ranges::sort(pieces, std::greater<>());
  return pieces;
}

ShapeReport report_shape(const Surface& surface, const SpaceGrid& grid, const VoxelGrid& voxels) {
  ShapeReport report;
  report.elements =
      std::size_t(std::ranges::count_if(voxels.occupied, [](auto c) { return c != 0; }));
  const LineReport lines(surface, grid);
  report.surface_volume = unpaired_edges(surface) > 0 ? std::numeric_limits<double>::quiet_NaN()
                          : lines.has_overlaps()      ? lines.volume()
                                                      : std::abs(enclosed_volume(surface));
  report.voxel_volume = double(report.elements) * grid.edge.prod();
  report.thinnest = lines.thinnest();
  report.pieces = pieces_of(voxels);
  return report;
}

} // namespace dss
